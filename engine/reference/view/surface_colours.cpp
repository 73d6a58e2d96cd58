#include "engine/reference/view/surface_colours.h"

#include "engine/reference/view/texture_lookup.h"

#include <algorithm>
#include <array>

namespace pmdsim::reference {

namespace {

using Corners = std::array<std::uint32_t, 3>;

Corners corners_of(const Scene &scene, std::uint32_t id) {
  if (id < scene.triangles.size())
    return scene.triangles[id].vertices;
  const std::uint32_t vertex = scene.discs[id - scene.triangles.size()].vertex;
  return {vertex, vertex, vertex};
}

// Exactly the first corner's where all have the same, so that rounding cuts no holes in a mask.
template <class Exact, class Value>
Exact interpolated(const std::vector<Value> &values, const Corners &corners, const glm::dvec3 &weights) {
  const Exact first(values[corners[0]]), second(values[corners[1]]), third(values[corners[2]]);
  return first + weights[1] * (second - first) + weights[2] * (third - first);
}

glm::dvec4 colour(const Scene &scene, const Paint &paint, std::uint32_t id, const glm::dvec3 &weights) {
  const Corners corners = corners_of(scene, id);
  glm::dvec4 colour(1.0);
  if (paint.texture && !scene.texture_coordinates.empty())
    colour = texture_colour(paint, interpolated<glm::dvec2>(scene.texture_coordinates, corners, weights));
  if (!scene.colours.empty())
    colour *= interpolated<glm::dvec4>(scene.colours, corners, weights);
  return colour;
}

} // namespace

bool is_there(const Scene &scene, std::uint32_t id, const glm::dvec3 &weights) {
  const Paint &paint = *scene.surfaces[scene.surface_of(id)].paint;
  // Files state alpha and cutoff as floats, to which "at least" has to hold: 0.7 is not below 0.7.
  const auto alpha = static_cast<float>(paint.alpha * colour(scene, paint, id, weights).a);
  return alpha >= static_cast<float>(paint.alpha_cutoff);
}

double painted_reflectivity(const Scene &scene, std::uint32_t id, const glm::dvec3 &weights) {
  const Surface &surface = scene.surfaces[scene.surface_of(id)];
  const glm::dvec3 rgb(colour(scene, *surface.paint, id, weights));
  return std::max(surface.reflectivity + glm::dot(surface.paint->reflectivity_rgb, rgb), 0.0);
}

} // namespace pmdsim::reference
