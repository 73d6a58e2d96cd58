#include "host/input/image/image_pixels.h"

#include "host/input/image/jpeg_image.h"
#include "host/input/image/png_image.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace pmdsim {

namespace {

constexpr std::array<unsigned char, 8> png_magic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<unsigned char, 3> jpeg_magic{0xff, 0xd8, 0xff};

bool starts_with(std::span<const unsigned char> bytes, std::span<const unsigned char> magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

} // namespace

ImagePixels decoded_image(std::span<const unsigned char> bytes, std::size_t max_pixels, const Place &place) {
  if (starts_with(bytes, png_magic))
    return decoded_png(bytes, max_pixels, place);
  if (starts_with(bytes, jpeg_magic))
    return decoded_jpeg(bytes, max_pixels, place);
  throw input_error(place, "expected a PNG or JPEG image, found neither");
}

void check_image_size(const glm::uvec2 &size, std::size_t max_pixels, const Place &place) {
  const std::string found = fmt::format("found an image of {} x {}", size.x, size.y);
  if (size.x > max_image_side || size.y > max_image_side)
    throw input_error(place, fmt::format("expected at most {} pixels a side, {}", max_image_side, found));
  if (std::size_t{size.x} * size.y > max_pixels)
    throw input_error(place, fmt::format("expected at most {} further pixels, {}", max_pixels, found));
}

} // namespace pmdsim
