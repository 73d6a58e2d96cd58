#pragma once
// The pixels of a drawing.

#include "host/output/pictures/canvas.h"

#include <cairo.h>
#include <cstdint>

namespace pmdsim::test {

// As 0xRRGGBB.
inline std::uint32_t pixel_of(Canvas &canvas, int x, int y) {
  cairo_surface_t *surface = cairo_get_target(canvas.context());
  cairo_surface_flush(surface);
  const unsigned char *row =
      cairo_image_surface_get_data(surface) + y * cairo_image_surface_get_stride(surface);
  return reinterpret_cast<const std::uint32_t *>(row)[x] & 0xffffffu;
}

// Those whose colour is meant.
template <class IsMeant>
int count_pixels(Canvas &canvas, const IsMeant &is_meant) {
  int count = 0;
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x)
      count += is_meant(pixel_of(canvas, x, y));
  return count;
}

} // namespace pmdsim::test
