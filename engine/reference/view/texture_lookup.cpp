#include "engine/reference/view/texture_lookup.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

} // namespace pmdsim::reference
