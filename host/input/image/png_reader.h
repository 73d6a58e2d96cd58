#pragma once
// libpng behind calls that return. libpng reports errors by longjmp, which must not leave out a destructor:
// here, and nowhere else, it jumps, and only over libpng's own frames.

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <png.h>
#include <span>

namespace pmdsim {

class PngReader {
public:
  // `bytes` outlive the reader.
  explicit PngReader(std::span<const unsigned char> bytes);
  PngReader(const PngReader &) = delete;
  PngReader &operator=(const PngReader &) = delete;
  ~PngReader();

  // First the header, then all rows. False: error() tells why, and nothing more can be read.
  bool read_header();
  // As RGBA; each row holds size().x * 4 * component_bytes(), the more significant byte first.
  bool read_rows(std::span<unsigned char *> rows);

  glm::uvec2 size() const;
  std::size_t component_bytes() const; // 1 or 2
  const char *error() const { return error_.data(); }

private:
  static void keep_error(png_structp png, png_const_charp message);
  static void ignore_warning(png_structp, png_const_charp) {}
  static void copy_bytes(png_structp png, png_bytep target, std::size_t count);
  void ask_for_rgba();

  std::span<const unsigned char> rest_;
  std::array<char, 160> error_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

} // namespace pmdsim
