#include "host/output/pictures/colour_map.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

constexpr std::array<Colour, 17> viridis_anchors{{{0.267, 0.005, 0.329},
                                                  {0.282, 0.095, 0.417},
                                                  {0.279, 0.175, 0.483},
                                                  {0.259, 0.251, 0.524},
                                                  {0.230, 0.321, 0.545},
                                                  {0.200, 0.386, 0.555},
                                                  {0.173, 0.447, 0.558},
                                                  {0.150, 0.506, 0.557},
                                                  {0.128, 0.565, 0.551},
                                                  {0.120, 0.624, 0.534},
                                                  {0.155, 0.682, 0.503},
                                                  {0.241, 0.737, 0.455},
                                                  {0.363, 0.787, 0.387},
                                                  {0.508, 0.829, 0.299},
                                                  {0.669, 0.862, 0.195},
                                                  {0.836, 0.886, 0.102},
                                                  {0.993, 0.906, 0.144}}};

constexpr std::array<Colour, 17> twilight_anchors{{{0.886, 0.850, 0.888},
                                                   {0.763, 0.808, 0.831},
                                                   {0.580, 0.707, 0.779},
                                                   {0.447, 0.591, 0.755},
                                                   {0.384, 0.460, 0.731},
                                                   {0.370, 0.316, 0.677},
                                                   {0.351, 0.167, 0.562},
                                                   {0.271, 0.076, 0.363},
                                                   {0.186, 0.078, 0.215},
                                                   {0.293, 0.075, 0.258},
                                                   {0.454, 0.116, 0.310},
                                                   {0.596, 0.207, 0.313},
                                                   {0.697, 0.337, 0.322},
                                                   {0.762, 0.485, 0.385},
                                                   {0.800, 0.638, 0.534},
                                                   {0.847, 0.777, 0.741},
                                                   {0.886, 0.850, 0.888}}};

constexpr std::array<Colour, 17> blue_white_red_anchors{{{0.000, 0.314, 0.607},
                                                         {0.000, 0.401, 0.701},
                                                         {0.149, 0.488, 0.791},
                                                         {0.277, 0.576, 0.865},
                                                         {0.408, 0.662, 0.920},
                                                         {0.544, 0.746, 0.957},
                                                         {0.684, 0.826, 0.975},
                                                         {0.826, 0.899, 0.978},
                                                         {0.961, 0.961, 0.961},
                                                         {0.975, 0.861, 0.834},
                                                         {0.967, 0.752, 0.703},
                                                         {0.939, 0.641, 0.575},
                                                         {0.892, 0.531, 0.453},
                                                         {0.828, 0.426, 0.342},
                                                         {0.748, 0.327, 0.242},
                                                         {0.654, 0.236, 0.154},
                                                         {0.557, 0.142, 0.058}}};

} // namespace

constinit const ColourMap viridis{viridis_anchors};
constinit const ColourMap twilight{twilight_anchors};
constinit const ColourMap blue_white_red{blue_white_red_anchors};

Colour ColourMap::at(double position) const {
  const double place = std::clamp(position, 0.0, 1.0) * static_cast<double>(anchors_.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), anchors_.size() - 2);
  const double fraction = place - static_cast<double>(below);
  Colour colour;
  for (std::size_t i = 0; i < colour.size(); ++i)
    colour[i] = std::lerp(anchors_[below][i], anchors_[below + 1][i], fraction);
  return colour;
}

} // namespace pmdsim
