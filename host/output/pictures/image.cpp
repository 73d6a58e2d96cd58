#include "host/output/pictures/image.h"

#include <algorithm>

namespace pmdsim {
namespace {

constexpr std::uint32_t enlarged_side = 512;

std::uint32_t side_of(const glm::uvec2 &resolution) { return std::max(resolution.x, resolution.y); }

float block_mean(std::span<const float> values, const glm::uvec2 &resolution, const glm::uvec2 &first,
                 std::uint32_t block) {
  double sum = 0.0, count = 0.0;
  for (std::size_t row = first.y; row < std::min(first.y + block, resolution.y); ++row)
    for (std::size_t column = first.x; column < std::min(first.x + block, resolution.x); ++column)
      if (const float value = values[row * resolution.x + column]; std::isfinite(value)) {
        sum += static_cast<double>(value);
        ++count;
      }
  return static_cast<float>(sum / count);
}

} // namespace

std::uint32_t rgb24(const Colour &colour) {
  const auto byte = [](double level) { return static_cast<std::uint32_t>(std::lround(255.0 * level)); };
  return byte(colour[0]) << 16 | byte(colour[1]) << 8 | byte(colour[2]);
}

std::uint32_t enlargement_of(const glm::uvec2 &resolution) {
  return std::max(1u, enlarged_side / side_of(resolution));
}

PreviewImage shrunk_image(std::span<const float> values, const glm::uvec2 &resolution, ColourScale scale,
                          std::uint32_t max_side) {
  const std::uint32_t block = (side_of(resolution) + max_side - 1) / max_side;
  PreviewImage image{(resolution + block - 1u) / block, {}, 1};
  image.values.reserve(std::size_t{image.resolution.x} * image.resolution.y);
  for (std::uint32_t row = 0; row < resolution.y; row += block)
    for (std::uint32_t column = 0; column < resolution.x; column += block)
      image.values.push_back(scale == ColourScale::turn
                                 ? values[std::size_t{row} * resolution.x + column]
                                 : block_mean(values, resolution, {column, row}, block));
  return image;
}

PreviewImage preview_image(std::span<const float> values, const glm::uvec2 &resolution, ColourScale scale) {
  PreviewImage image = shrunk_image(values, resolution, scale, max_preview_side);
  image.enlargement = enlargement_of(resolution);
  return image;
}

SurfacePtr coloured(const PreviewImage &image, const Colouring &colouring) {
  return make_image(image.resolution, [&](std::uint32_t column, std::uint32_t row) {
    const float value = image.values[std::size_t{row} * image.resolution.x + column];
    return std::isfinite(value) ? colouring.at(static_cast<double>(value)) : no_value_colour;
  });
}

} // namespace pmdsim
