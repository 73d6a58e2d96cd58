#include "host/input/image/png_image.h"

#include "host/input/image/png_reader.h"

#include <fmt/format.h>

namespace pmdsim {

namespace {

Error broken(const PngReader &reader, const Place &place) {
  return input_error(place, fmt::format("no valid PNG: {}", reader.error()));
}

} // namespace

ImagePixels decoded_png(std::span<const unsigned char> bytes, std::size_t max_pixels, const Place &place) {
  PngReader reader(bytes);
  if (!reader.read_header())
    throw broken(reader, place);
  check_image_size(reader.size(), max_pixels, place);

  ImagePixels pixels{reader.size(), reader.component_bytes()};
  const std::size_t row_bytes = std::size_t{pixels.size.x} * 4 * pixels.component_bytes;
  pixels.rgba.resize(row_bytes * pixels.size.y);
  std::vector<unsigned char *> rows(pixels.size.y);
  for (std::size_t row = 0; row < rows.size(); ++row)
    rows[row] = pixels.rgba.data() + row * row_bytes;
  if (!reader.read_rows(rows))
    throw broken(reader, place);
  return pixels;
}

} // namespace pmdsim
