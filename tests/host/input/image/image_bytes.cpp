#include "tests/host/input/image/image_bytes.h"

#include <memory>
#include <png.h>
#include <stdexcept>
#include <turbojpeg.h>
#include <zlib.h>

namespace pmdsim::test {

namespace {

[[noreturn]] void fail(png_structp, png_const_charp message) {
  std::fputs(message, stderr);
  std::abort();
}

void append(png_structp png, png_bytep data, std::size_t count) {
  static_cast<std::string *>(png_get_io_ptr(png))->append(reinterpret_cast<const char *>(data), count);
}

void set_transparency(png_structp png, png_infop info, const PngImage &image) {
  png_color_16 colour{};
  if (image.transparent.size() == 1)
    colour.gray = image.transparent[0];
  if (image.transparent.size() == 3) {
    colour.red = image.transparent[0];
    colour.green = image.transparent[1];
    colour.blue = image.transparent[2];
  }
  if (!image.transparent.empty())
    png_set_tRNS(png, info, nullptr, 0, &colour);
  if (!image.palette_alpha.empty())
    png_set_tRNS(png, info, image.palette_alpha.data(), static_cast<int>(image.palette_alpha.size()),
                 nullptr);
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<char>(value >> shift & 0xffu));
  return bytes;
}

} // namespace

std::string png_bytes(const PngImage &image) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, append, nullptr);
  png_set_IHDR(png, info, image.width, image.height, image.bits, image.colour_type,
               image.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_color> palette;
  for (std::size_t i = 0; i < image.palette.size(); i += 3)
    palette.push_back({image.palette[i], image.palette[i + 1], image.palette[i + 2]});
  if (!palette.empty())
    png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  set_transparency(png, info, image);
  if (image.gamma > 0.0)
    png_set_gAMA(png, info, image.gamma);
  std::vector<std::uint8_t> pixels = image.rows;
  if (pixels.size() != image.height * png_get_rowbytes(png, info))
    throw std::logic_error("a PNG's rows have the wrong size");
  std::vector<png_bytep> rows;
  for (std::size_t row = 0; row < image.height; ++row)
    rows.push_back(pixels.data() + row * png_get_rowbytes(png, info));
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::string png_chunk(const std::string &type, const std::string &data) {
  const std::string body = type + data;
  const auto crc = crc32(0, reinterpret_cast<const Bytef *>(body.data()), static_cast<uInt>(body.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + body +
         big_endian(static_cast<std::uint32_t>(crc));
}

std::string png_header(std::uint32_t width, std::uint32_t height) {
  const std::string rgba_of_8_bits("\x08\x06\0\0\0", 5);
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", big_endian(width) + big_endian(height) + rgba_of_8_bits) +
         big_endian(1) + "IDAT";
}

std::string jpeg_bytes(int width, int height, const std::vector<std::uint8_t> &pixels, JpegColours colours,
                       bool is_progressive) {
  const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), tjDestroy);
  const int format = colours == JpegColours::grey   ? TJPF_GRAY
                     : colours == JpegColours::cmyk ? TJPF_CMYK
                                                    : TJPF_RGB;
  unsigned char *encoded = nullptr;
  unsigned long size = 0;
  const bool failed = tjCompress2(encoder.get(), pixels.data(), width, 0, height, format, &encoded, &size,
                                  colours == JpegColours::grey ? TJSAMP_GRAY : TJSAMP_444, 100,
                                  TJFLAG_ACCURATEDCT | (is_progressive ? TJFLAG_PROGRESSIVE : 0)) != 0;
  const std::unique_ptr<unsigned char, void (*)(unsigned char *)> owned(encoded, tjFree);
  if (failed)
    throw std::logic_error(tjGetErrorStr2(encoder.get()));
  return {reinterpret_cast<const char *>(encoded), size};
}

std::string jpeg_of_one_pixel(std::uint16_t width, std::uint16_t height) {
  constexpr bool is_progressive = true;
  std::string bytes = jpeg_bytes(1, 1, {0, 0, 0}, JpegColours::rgb, is_progressive);
  const std::size_t frame = bytes.find("\xff\xc2"); // its length of two bytes and a depth go before the sides
  const auto set = [&](std::size_t at, std::uint16_t side) {
    bytes[at] = static_cast<char>(side >> 8);
    bytes[at + 1] = static_cast<char>(side & 0xff);
  };
  set(frame + 5, height);
  set(frame + 7, width);
  return bytes;
}

} // namespace pmdsim::test
