#include "host/input/image/image_pixels.h"

#include "host/input/image/png_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <new>
#include <turbojpeg.h>

namespace pmdsim {
namespace {

constexpr std::array<unsigned char, 8> png_magic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<unsigned char, 3> jpeg_magic{0xff, 0xd8, 0xff};

bool starts_with(std::span<const unsigned char> bytes, std::span<const unsigned char> magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

// Throws Error (input) at `place`.
void check_image_size(const glm::uvec2 &size, std::size_t max_pixels, const Place &place) {
  const std::string found = fmt::format("found an image of {} x {}", size.x, size.y);
  if (size.x > max_image_side || size.y > max_image_side)
    throw input_error(place, fmt::format("expected at most {} pixels a side, {}", max_image_side, found));
  if (std::size_t{size.x} * size.y > max_pixels)
    throw input_error(place, fmt::format("expected at most {} further pixels, {}", max_pixels, found));
}

Error broken(const PngReader &reader, const Place &place) {
  return input_error(place, fmt::format("no valid PNG: {}", reader.error()));
}

// Every colour type and depth, tRNS, interlaced or not.
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

struct Destroy {
  void operator()(void *decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<void, Destroy>;

Error broken(const Decoder &decoder, const Place &place) {
  return input_error(place, fmt::format("no valid JPEG: {}", tjGetErrorStr2(decoder.get())));
}

// 8 bits, grey or colour, baseline or progressive. What libjpeg would only warn of, such as an image that is
// cut short, is an error too.
ImagePixels decoded_jpeg(std::span<const unsigned char> bytes, std::size_t max_pixels, const Place &place) {
  const Decoder decoder(tjInitDecompress());
  if (!decoder)
    throw std::bad_alloc();
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(decoder.get(), bytes.data(), bytes.size(), &width, &height, &subsampling,
                          &colours) != 0)
    throw broken(decoder, place);
  if (colours == TJCS_CMYK || colours == TJCS_YCCK)
    throw input_error(place, "expected a JPEG in grey or colour, found CMYK");
  ImagePixels pixels{{width, height}};
  check_image_size(pixels.size, max_pixels, place);

  pixels.rgba.resize(std::size_t{4} * pixels.size.x * pixels.size.y);
  constexpr int tightly = 0; // rows follow one another without a gap
  if (tjDecompress2(decoder.get(), bytes.data(), bytes.size(), pixels.rgba.data(), width, tightly, height,
                    TJPF_RGBA, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0)
    throw broken(decoder, place);
  return pixels;
}

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

ImagePixels decoded_image(std::span<const unsigned char> bytes, std::size_t max_pixels, const Place &place) {
  if (starts_with(bytes, png_magic))
    return decoded_png(bytes, max_pixels, place);
  if (starts_with(bytes, jpeg_magic))
    return decoded_jpeg(bytes, max_pixels, place);
  throw input_error(place, "expected a PNG or JPEG image, found neither");
}

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
