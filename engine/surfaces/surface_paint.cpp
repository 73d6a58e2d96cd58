#include "engine/surfaces/surface_paint.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

// The texel that a coordinate outside of the texture folds back to.
std::size_t folded(double texel, std::size_t size, Wrap wrap) {
  const auto n = static_cast<double>(size);
  switch (wrap) {
  case Wrap::repeat:
    texel -= n * std::floor(texel / n);
    break;
  case Wrap::mirrored_repeat:
    texel -= 2.0 * n * std::floor(texel / (2.0 * n));
    texel = texel < n ? texel : 2.0 * n - 1.0 - texel;
    break;
  case Wrap::clamp:
    break;
  }
  return static_cast<std::size_t>(std::clamp(texel, 0.0, n - 1.0));
}

glm::dvec4 texel_at(const Paint &paint, double column, double row) {
  const glm::uvec2 size = paint.texture->size;
  return paint.texture
      ->texels[folded(row, size.y, paint.wrap_v) * size.x + folded(column, size.x, paint.wrap_u)];
}

glm::dvec4 texture_at(const Paint &paint, const glm::dvec2 &coordinates) {
  const glm::dvec2 place = coordinates * glm::dvec2(paint.texture->size);
  if (paint.filter == TextureFilter::nearest)
    return texel_at(paint, std::floor(place.x), std::floor(place.y));
  const glm::dvec2 low = glm::floor(place - 0.5), part = place - 0.5 - low;
  const auto row = [&](double y) {
    return (1.0 - part.x) * texel_at(paint, low.x, y) + part.x * texel_at(paint, low.x + 1.0, y);
  };
  return (1.0 - part.y) * row(low.y) + part.y * row(low.y + 1.0);
}

using Vertices = std::array<std::uint32_t, 3>;

// The vertices of a triangle, or three times that of a disc.
Vertices corners_of(const Scene &scene, std::uint32_t shape) {
  if (!scene.is_disc(shape))
    return scene.triangles[shape].vertices;
  const std::uint32_t vertex = scene.discs[shape - scene.triangles.size()].vertex;
  return {vertex, vertex, vertex};
}

template <class Value>
auto mix(const std::vector<Value> &of_vertices, const Vertices &corners, const CornerWeights &weights) {
  const auto &[a, b, c] = corners;
  using Double = std::conditional_t<std::is_same_v<Value, glm::vec4>, glm::dvec4, Value>;
  return weights.x * Double(of_vertices[a]) + weights.y * Double(of_vertices[b]) +
         weights.z * Double(of_vertices[c]);
}

glm::dvec4 colour_at(const Scene &scene, const Paint &paint, const Vertices &vertices,
                     const CornerWeights &weights) {
  glm::dvec4 colour(1.0);
  if (!scene.colours.empty())
    colour = mix(scene.colours, vertices, weights);
  if (paint.texture && !scene.texture_coordinates.empty())
    colour *= texture_at(paint, mix(scene.texture_coordinates, vertices, weights));
  return colour;
}

// The spread of a part of a triangle over its texture, in texels.
double texels_across(const Scene &scene, const Paint &paint, const Vertices &vertices,
                     const std::array<CornerWeights, 3> &corners) {
  if (!paint.texture || scene.texture_coordinates.empty())
    return 1.0;
  std::array<glm::dvec2, 3> places;
  for (std::size_t i = 0; i < 3; ++i)
    places[i] = mix(scene.texture_coordinates, vertices, corners[i]) * glm::dvec2(paint.texture->size);
  return std::max({glm::distance(places[0], places[1]), glm::distance(places[1], places[2]),
                   glm::distance(places[2], places[0])});
}

} // namespace

double reflectivity_at(const Scene &scene, std::uint32_t shape, const CornerWeights &weights) {
  const Surface &surface = scene.surfaces[scene.surface_of(shape)];
  if (!surface.paint)
    return surface.reflectivity;
  const glm::dvec4 colour = colour_at(scene, *surface.paint, corners_of(scene, shape), weights);
  return std::max(surface.reflectivity + glm::dot(surface.paint->reflectivity_rgb, glm::dvec3(colour)), 0.0);
}

bool is_there_at(const Scene &scene, std::uint32_t triangle, const CornerWeights &weights) {
  const auto &paint = scene.surfaces[scene.triangles[triangle].surface].paint;
  if (!paint || paint->alpha_cutoff <= 0.0)
    return true;
  // Files state both as floats.
  const double alpha = paint->alpha * colour_at(scene, *paint, corners_of(scene, triangle), weights).a;
  return static_cast<float>(alpha) >= static_cast<float>(paint->alpha_cutoff);
}

double mean_reflectivity(const Scene &scene, std::uint32_t triangle,
                         const std::array<CornerWeights, 3> &corners) {
  constexpr double most_per_edge = 32.0;
  const Surface &surface = scene.surfaces[scene.triangles[triangle].surface];
  if (!surface.paint)
    return surface.reflectivity;
  const double across = texels_across(scene, *surface.paint, corners_of(scene, triangle), corners);
  const auto n = static_cast<int>(std::clamp(std::ceil(across), 2.0, most_per_edge));
  double sum = 0.0;
  // The centres of n * n equal parts: of those that point up, and of those between them.
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n - i; ++j)
      for (int down = 0; down < (i + j < n - 1 ? 2 : 1); ++down) {
        const double third = down == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
        const double b = (i + third) / n, c = (j + third) / n;
        sum += reflectivity_at(scene, triangle, (1.0 - b - c) * corners[0] + b * corners[1] + c * corners[2]);
      }
  return sum / (n * n);
}

} // namespace pmdsim
