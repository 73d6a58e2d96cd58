#include "host/input/image/srgb_texture.h"

#include <cmath>

namespace pmdsim {

namespace {

std::size_t stored_number(const ImagePixels &pixels, std::size_t component) {
  if (pixels.component_bytes == 1)
    return pixels.rgba[component];
  return std::size_t{256} * pixels.rgba[2 * component] + pixels.rgba[2 * component + 1];
}

// What each number that can be stored means, in linear light.
std::vector<float> linear_of_stored(std::size_t largest) {
  std::vector<float> linear(largest + 1);
  for (std::size_t stored = 0; stored <= largest; ++stored)
    linear[stored] =
        static_cast<float>(linear_from_srgb(static_cast<double>(stored) / static_cast<double>(largest)));
  return linear;
}

} // namespace

double linear_from_srgb(double stored) {
  return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

Texture linear_texture(const ImagePixels &pixels) {
  const std::size_t largest = pixels.component_bytes == 1 ? 0xff : 0xffff;
  const std::vector<float> linear = linear_of_stored(largest);
  Texture texture{pixels.size, std::vector<glm::vec4>(std::size_t{pixels.size.x} * pixels.size.y)};
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    const auto stored = [&](std::size_t c) { return stored_number(pixels, 4 * i + c); };
    const double alpha = static_cast<double>(stored(3)) / static_cast<double>(largest);
    texture.texels[i] = {linear[stored(0)], linear[stored(1)], linear[stored(2)], alpha};
  }
  return texture;
}

} // namespace pmdsim
