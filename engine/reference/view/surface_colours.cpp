#include "engine/reference/view/surface_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pmdsim::reference {

namespace {

// Texel indices are whole doubles until they are folded into the texture: coordinates may be larger than any
// integer.
double modulo(double index, double size) {
  const double remainder = std::fmod(index, size);
  return remainder < 0 ? remainder + size : remainder;
}

std::size_t folded(double index, std::uint32_t texels, Wrap wrap) {
  const double size = texels;
  double inside = 0.0;
  switch (wrap) {
  case Wrap::repeat:
    inside = modulo(index, size);
    break;
  case Wrap::mirrored_repeat:
    inside = modulo(index, 2 * size);
    inside = inside < size ? inside : 2 * size - 1 - inside;
    break;
  case Wrap::clamp:
    inside = std::clamp(index, 0.0, size - 1);
    break;
  }
  return static_cast<std::size_t>(inside);
}

glm::dvec4 texel(const Paint &paint, const glm::dvec2 &index) {
  const Texture &texture = *paint.texture;
  const std::size_t column = folded(index.x, texture.size.x, paint.wrap_u);
  const std::size_t row = folded(index.y, texture.size.y, paint.wrap_v);
  return texture.texels[row * texture.size.x + column];
}

// Exactly `a` between equal ends, so that rounding cuts no holes in a mask.
glm::dvec4 between(const glm::dvec4 &a, const glm::dvec4 &b, double fraction) {
  return a + fraction * (b - a);
}

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

glm::dvec4 texture_colour(const Paint &paint, const glm::dvec2 &coordinates) {
  const glm::dvec2 place = coordinates * glm::dvec2(paint.texture->size);
  if (paint.filter == TextureFilter::nearest)
    return texel(paint, glm::floor(place));
  const glm::dvec2 from_centre = place - 0.5;
  const glm::dvec2 first = glm::floor(from_centre), fraction = from_centre - first;
  const auto row_colour = [&](double row) {
    return between(texel(paint, {first.x, row}), texel(paint, {first.x + 1, row}), fraction.x);
  };
  return between(row_colour(first.y), row_colour(first.y + 1), fraction.y);
}

bool is_there(const Scene &scene, std::uint32_t id, const glm::dvec3 &weights) {
  const Paint &paint = *scene.surfaces[scene.surface_of(id)].paint;
  // Files state alpha and cutoff as floats, to which "at least" has to hold: 0.7 is not below 0.7.
  const auto alpha = static_cast<float>(paint.alpha * colour(scene, paint, id, weights).a);
  return alpha >= static_cast<float>(paint.alpha_cutoff);
}

double reflectivity(const Scene &scene, std::uint32_t id, const glm::dvec3 &weights) {
  const Surface &surface = scene.surfaces[scene.surface_of(id)];
  if (!surface.paint)
    return surface.reflectivity;
  const glm::dvec3 rgb(colour(scene, *surface.paint, id, weights));
  return std::max(surface.reflectivity + glm::dot(surface.paint->reflectivity_rgb, rgb), 0.0);
}

} // namespace pmdsim::reference
