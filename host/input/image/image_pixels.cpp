#include "host/input/image/image_pixels.h"

#include "host/input/file/memory_request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <new>
#include <png.h>
#include <string>
#include <string_view>
#include <turbojpeg.h>

namespace pmdsim {
namespace {

constexpr std::array<unsigned char, 8> png_magic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<unsigned char, 3> jpeg_magic{0xff, 0xd8, 0xff};

bool starts_with(std::span<const unsigned char> bytes, std::span<const unsigned char> magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

// libpng behind calls that return. libpng reports errors by longjmp, which must not leave out a destructor:
// here, and nowhere else, it jumps, and only over libpng's own frames.
class PngReader {
public:
  // `bytes` outlive the reader.
  explicit PngReader(std::span<const unsigned char> bytes) : rest_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, keep_error, ignore_warning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  PngReader(const PngReader &) = delete;
  PngReader &operator=(const PngReader &) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // First the header, then all rows. False: error() tells why, and nothing more can be read.
  bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0)
      return false;
    png_set_read_fn(png_, this, copy_bytes);
    // Whoever decodes says which size is too large, in better words than "Invalid IHDR data".
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    // Drops gamma, colour profiles and whatever else is neither pixels nor tRNS.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_info(png_, info_);
    return true;
  }

  // As RGBA; each row holds size().x * 4 * component_bytes(), the more significant byte first.
  bool read_rows(std::span<unsigned char *> rows) {
    if (setjmp(png_jmpbuf(png_)) != 0)
      return false;
    png_set_expand(png_); // palettes and tRNS to colours, 1, 2 and 4 bits to 8
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, component_bytes() == 2 ? 0xffff : 0xff, PNG_FILLER_AFTER);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    if (rows.size() != size().y ||
        png_get_rowbytes(png_, info_) != std::size_t{4} * size().x * component_bytes())
      png_error(png_, "the rows have another size than stated");
    png_read_image(png_, rows.data());
    png_read_end(png_, nullptr);
    return true;
  }

  glm::uvec2 size() const { return {png_get_image_width(png_, info_), png_get_image_height(png_, info_)}; }
  std::size_t component_bytes() const { return png_get_bit_depth(png_, info_) == 16 ? 2 : 1; }
  const char *error() const { return error_.data(); }

private:
  // libpng calls this from C, and it must not return.
  static void keep_error(png_structp png, png_const_charp message) {
    auto &error = static_cast<PngReader *>(png_get_error_ptr(png))->error_;
    std::string_view(message).copy(error.data(), error.size() - 1);
    png_longjmp(png, 1);
  }
  static void ignore_warning(png_structp, png_const_charp) {}

  static void copy_bytes(png_structp png, png_bytep target, std::size_t count) {
    auto &rest = static_cast<PngReader *>(png_get_io_ptr(png))->rest_;
    if (count > rest.size())
      png_error(png, "the image is cut short");
    std::copy_n(rest.begin(), count, target);
    rest = rest.subspan(count);
  }

  std::span<const unsigned char> rest_;
  std::array<char, 160> error_{}; // ends with a NUL
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

// Throws Error (input), and (out_of_memory) where there is no room for them, at `place`.
void check_image_size(const glm::uvec2 &size, std::size_t pixel_bytes, std::size_t max_pixels,
                      const Place &place) {
  const std::string found = fmt::format("found an image of {} x {}", size.x, size.y);
  if (size.x > max_image_side || size.y > max_image_side)
    throw input_error(place, fmt::format("expected at most {} pixels a side, {}", max_image_side, found));
  if (std::size_t{size.x} * size.y > max_pixels)
    throw input_error(place, fmt::format("expected at most {} further pixels, {}", max_pixels, found));
  require_memory(std::size_t{size.x} * size.y * pixel_bytes, place,
                 fmt::format("an image of {} x {}", size.x, size.y));
}

Error broken(const PngReader &reader, const Place &place) {
  return input_error(place, fmt::format("no valid PNG: {}", reader.error()));
}

// Every colour type and depth, tRNS, interlaced or not.
ImagePixels decoded_png(std::span<const unsigned char> bytes, std::size_t max_pixels, const Place &place) {
  PngReader reader(bytes);
  if (!reader.read_header())
    throw broken(reader, place);
  check_image_size(reader.size(), 4 * reader.component_bytes(), max_pixels, place);

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

// 8 bits, grey or colour, baseline or progressive. Faults that libjpeg would only warn of, such as an image
// that is cut short, are errors too.
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
  // libjpeg keeps the coefficients of an image of several scans, 2 bytes each of three components.
  check_image_size(pixels.size, 4 + 3 * 2, max_pixels, place);

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

std::size_t largest_number(const ImagePixels &pixels) { return pixels.component_bytes == 1 ? 0xff : 0xffff; }

// The linear light that each number that can be stored means.
std::vector<float> linear_of_stored(std::size_t largest) {
  std::vector<float> linear(largest + 1);
  for (std::size_t stored = 0; stored <= largest; ++stored)
    linear[stored] =
        static_cast<float>(linear_from_srgb(static_cast<double>(stored) / static_cast<double>(largest)));
  return linear;
}

const std::vector<float> &linear_table(std::size_t component_bytes) {
  static const std::vector<float> of_one_byte = linear_of_stored(0xff),
                                  of_two_bytes = linear_of_stored(0xffff);
  return component_bytes == 1 ? of_one_byte : of_two_bytes;
}

} // namespace

ImagePixels decoded_image(std::span<const unsigned char> bytes, std::size_t max_pixels, const Place &place) {
  if (starts_with(bytes, png_magic))
    return decoded_png(bytes, max_pixels, place);
  if (starts_with(bytes, jpeg_magic))
    return decoded_jpeg(bytes, max_pixels, place);
  throw input_error(place, "expected a PNG or JPEG image, found neither");
}

double stored_share(const ImagePixels &pixels, std::size_t component) {
  return static_cast<double>(stored_number(pixels, component)) / static_cast<double>(largest_number(pixels));
}

double linear_from_srgb(double stored) {
  return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

Texture linear_texture(const ImagePixels &pixels) {
  const std::vector<float> &linear = linear_table(pixels.component_bytes);
  Texture texture{pixels.size, std::vector<glm::vec4>(std::size_t{pixels.size.x} * pixels.size.y)};
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    const auto stored = [&](std::size_t c) { return stored_number(pixels, 4 * i + c); };
    texture.texels[i] = {linear[stored(0)], linear[stored(1)], linear[stored(2)],
                         stored_share(pixels, 4 * i + 3)};
  }
  return texture;
}

} // namespace pmdsim
