#include "host/output/pictures/colour_map.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {

constinit const ColourMap viridis{{{{0.267, 0.282, 0.279, 0.259, 0.230, 0.200, 0.173, 0.150, 0.128, 0.120,
                                     0.155, 0.241, 0.363, 0.508, 0.669, 0.836, 0.993},
                                    {0.005, 0.095, 0.175, 0.251, 0.321, 0.386, 0.447, 0.506, 0.565, 0.624,
                                     0.682, 0.737, 0.787, 0.829, 0.862, 0.886, 0.906},
                                    {0.329, 0.417, 0.483, 0.524, 0.545, 0.555, 0.558, 0.557, 0.551, 0.534,
                                     0.503, 0.455, 0.387, 0.299, 0.195, 0.102, 0.144}}}};
constinit const ColourMap twilight{{{{0.886, 0.763, 0.580, 0.447, 0.384, 0.370, 0.351, 0.271, 0.186, 0.293,
                                      0.454, 0.596, 0.697, 0.762, 0.800, 0.847, 0.886},
                                     {0.850, 0.808, 0.707, 0.591, 0.460, 0.316, 0.167, 0.076, 0.078, 0.075,
                                      0.116, 0.207, 0.337, 0.485, 0.638, 0.777, 0.850},
                                     {0.888, 0.831, 0.779, 0.755, 0.731, 0.677, 0.562, 0.363, 0.215, 0.258,
                                      0.310, 0.313, 0.322, 0.385, 0.534, 0.741, 0.888}}}};
constinit const ColourMap blue_white_red{{{{0.000, 0.000, 0.149, 0.277, 0.408, 0.544, 0.684, 0.826, 0.961,
                                            0.975, 0.967, 0.939, 0.892, 0.828, 0.748, 0.654, 0.557},
                                           {0.314, 0.401, 0.488, 0.576, 0.662, 0.746, 0.826, 0.899, 0.961,
                                            0.861, 0.752, 0.641, 0.531, 0.426, 0.327, 0.236, 0.142},
                                           {0.607, 0.701, 0.791, 0.865, 0.920, 0.957, 0.975, 0.978, 0.961,
                                            0.834, 0.703, 0.575, 0.453, 0.342, 0.242, 0.154, 0.058}}}};

Colour ColourMap::at(double position) const {
  constexpr std::size_t last = anchors - 1;
  const double place = std::clamp(position, 0.0, 1.0) * static_cast<double>(last);
  const auto below = std::min(static_cast<std::size_t>(place), last - 1);
  const double fraction = place - static_cast<double>(below);
  Colour colour;
  for (std::size_t i = 0; i < colour.size(); ++i)
    colour[i] = std::lerp(levels[i][below], levels[i][below + 1], fraction);
  return colour;
}

} // namespace pmdsim
