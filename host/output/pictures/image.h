#pragma once
// A channel's values as an image: shrunk or enlarged by whole factors, and coloured.

#include "engine/model/channels.h"
#include "host/output/pictures/canvas.h"
#include "host/output/pictures/colouring.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace pmdsim {

// The picture's image area: at most 1024 pixels a side (whole blocks of pixels averaged, for `turn` their
// first taken, since angles do not average), small frames enlarged by a whole factor.
struct PreviewImage {
  glm::uvec2 resolution;     // of `values`
  std::vector<float> values; // NaN where a block holds no value
  std::uint32_t enlargement; // picture pixels a value
};

inline constexpr std::uint32_t max_preview_side = 1024;

PreviewImage preview_image(std::span<const float> values, const glm::uvec2 &resolution, ColourScale scale);
// The same of at most `max_side` pixels a side, not enlarged.
PreviewImage shrunk_image(std::span<const float> values, const glm::uvec2 &resolution, ColourScale scale,
                          std::uint32_t max_side);
// The factor that makes an image of this size one for people.
std::uint32_t enlargement_of(const glm::uvec2 &resolution);

// The image as a surface to draw; a value that is none is grey.
SurfacePtr coloured(const PreviewImage &image, const Colouring &colouring);

std::uint32_t rgb24(const Colour &colour);

// A surface whose pixels have the colours that colour_of_pixel(column, row) gives.
template <typename ColourOfPixel>
SurfacePtr make_image(const glm::uvec2 &resolution, ColourOfPixel colour_of_pixel) {
  SurfacePtr surface = make_surface(static_cast<int>(resolution.x), static_cast<int>(resolution.y));
  unsigned char *bytes = cairo_image_surface_get_data(surface.get());
  const int stride_bytes = cairo_image_surface_get_stride(surface.get());
  for (std::uint32_t row = 0; row < resolution.y; ++row) {
    auto *pixels = reinterpret_cast<std::uint32_t *>(bytes + static_cast<std::ptrdiff_t>(row) * stride_bytes);
    for (std::uint32_t column = 0; column < resolution.x; ++column)
      pixels[column] = rgb24(colour_of_pixel(column, row));
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

} // namespace pmdsim
