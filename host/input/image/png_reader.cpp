#include "host/input/image/png_reader.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace pmdsim {

PngReader::PngReader(std::span<const unsigned char> bytes) : rest_(bytes) {
  png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, keep_error, ignore_warning);
  info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
  if (info_ == nullptr) {
    png_destroy_read_struct(&png_, nullptr, nullptr);
    throw std::bad_alloc();
  }
}

PngReader::~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

// libpng calls this from C, and it must not return.
void PngReader::keep_error(png_structp png, png_const_charp message) {
  auto &error = static_cast<PngReader *>(png_get_error_ptr(png))->error_;
  const std::size_t length = std::min(std::strlen(message), error.size() - 1);
  std::copy_n(message, length, error.begin());
  error[length] = '\0';
  png_longjmp(png, 1);
}

void PngReader::copy_bytes(png_structp png, png_bytep target, std::size_t count) {
  auto &rest = static_cast<PngReader *>(png_get_io_ptr(png))->rest_;
  if (count > rest.size())
    png_error(png, "the image is cut short");
  std::copy_n(rest.begin(), count, target);
  rest = rest.subspan(count);
}

bool PngReader::read_header() {
  if (setjmp(png_jmpbuf(png_)) != 0)
    return false;
  png_set_read_fn(png_, this, copy_bytes);
  // Whoever decodes says which size is too large, in better words than "Invalid IHDR data".
  png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  // Gamma, colour profiles and whatever else is neither pixels nor tRNS.
  png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(png_, info_);
  return true;
}

void PngReader::ask_for_rgba() {
  png_set_expand(png_); // palettes and tRNS to colours, 1, 2 and 4 bits to 8
  png_set_gray_to_rgb(png_);
  png_set_add_alpha(png_, component_bytes() == 2 ? 0xffff : 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png_);
  png_read_update_info(png_, info_);
}

bool PngReader::read_rows(std::span<unsigned char *> rows) {
  if (setjmp(png_jmpbuf(png_)) != 0)
    return false;
  ask_for_rgba();
  if (rows.size() != size().y ||
      png_get_rowbytes(png_, info_) != std::size_t{4} * size().x * component_bytes())
    png_error(png_, "the rows have another size than stated");
  png_read_image(png_, rows.data());
  png_read_end(png_, nullptr);
  return true;
}

glm::uvec2 PngReader::size() const {
  return {png_get_image_width(png_, info_), png_get_image_height(png_, info_)};
}

std::size_t PngReader::component_bytes() const { return png_get_bit_depth(png_, info_) == 16 ? 2 : 1; }

} // namespace pmdsim
