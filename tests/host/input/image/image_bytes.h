#pragma once
// Small images for tests to load or to break.

#include <cstdint>
#include <string>
#include <vector>

namespace pmdsim::test {

// The contents of a PNG: rows as the format packs them, the more significant byte first.
struct PngImage {
  std::uint32_t width = 1, height = 1;
  int bits = 8;
  int colour_type = 2; // 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
  std::vector<std::uint8_t> rows{};
  std::vector<std::uint8_t> palette{};       // RGB, RGB ...
  std::vector<std::uint8_t> palette_alpha{}; // tRNS of a palette
  std::vector<std::uint16_t> transparent{};  // tRNS of grey (1) or RGB (3)
  bool interlaced = false;
  double gamma = 0.0; // gAMA, or none
};

std::string png_bytes(const PngImage &image);
// The front of a PNG in RGBA, as far as what follows the header begins: no pixels.
std::string png_header(std::uint32_t width, std::uint32_t height);
// The chunk, with a good CRC.
std::string png_chunk(const std::string &type, const std::string &data);

enum class JpegColours { rgb, grey, cmyk };
// A progressive JPEG whose header tells of so many pixels: it has one.
std::string jpeg_of_one_pixel(std::uint16_t width, std::uint16_t height);
// JPEG of the best quality without subsampling.
std::string jpeg_bytes(int width, int height, const std::vector<std::uint8_t> &pixels,
                       JpegColours colours = JpegColours::rgb, bool is_progressive = false);

} // namespace pmdsim::test
