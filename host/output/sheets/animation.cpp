#include "host/output/sheets/animation.h"

#include <libdeflate.h>
#include <stdexcept>
#include <string_view>

// Source: PNG Specification (Third Edition), "11.3.6 Animation information". Cairo writes each image as a PNG
// of its own; what its IDAT chunks hold is taken over.
namespace pmdsim {
namespace {

constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";

// Big-endian, as all numbers of PNG.
template <class Value>
std::string big_endian(Value value) {
  std::string bytes(sizeof(Value), '\0');
  for (std::size_t i = 0; i < sizeof(Value); ++i)
    bytes[i] = static_cast<char>(value >> 8 * (sizeof(Value) - 1 - i));
  return bytes;
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// What is needed of a PNG that Cairo has written.
struct PngParts {
  std::string header, data; // the content of IHDR, and of all IDAT chunks
};

PngParts parts_of(std::string_view png) {
  PngParts parts;
  constexpr std::size_t around = 12; // length, type and checksum
  for (std::size_t at = signature.size(); at + around <= png.size();) {
    const std::size_t length = number_at(png, at);
    const std::string_view type = png.substr(at + 4, 4), content = png.substr(at + 8, length);
    if (type == "IHDR")
      parts.header = content;
    else if (type == "IDAT")
      parts.data += content;
    at += around + length;
  }
  return parts;
}

} // namespace

AnimatedPng::AnimatedPng(OutputFile &file, std::uint32_t frames, std::uint16_t frame_ms)
    : file_(file), frames_(frames), frame_ms_(frame_ms) {}

void AnimatedPng::write_chunk(const std::string &type, const std::string &content) {
  const std::string checked = type + content;
  file_.write(big_endian(static_cast<std::uint32_t>(content.size())) + checked +
              big_endian(libdeflate_crc32(0, checked.data(), checked.size())));
}

// fcTL: the whole image, for so many milliseconds, in place of the one before.
void AnimatedPng::write_control(const std::string &header) {
  const std::string size = header.substr(0, 8), offset(8, '\0'), replaces(2, '\0');
  write_chunk("fcTL", big_endian(sequence_++) + size + offset + big_endian(frame_ms_) +
                          big_endian(std::uint16_t{1000}) + replaces);
}

void AnimatedPng::add(const Canvas &canvas) {
  const PngParts parts = parts_of(canvas.png());
  if (added_ == 0) {
    header_ = parts.header;
    file_.write(signature);
    write_chunk("IHDR", header_);
    write_chunk("acTL", big_endian(frames_) + big_endian(std::uint32_t{0}));
  }
  if (parts.header != header_)
    throw std::logic_error("images of an animation that differ in size");
  write_control(parts.header);
  if (added_ == 0)
    write_chunk("IDAT", parts.data);
  else
    write_chunk("fdAT", big_endian(sequence_++) + parts.data);
  ++added_;
}

void AnimatedPng::end() {
  if (added_ != frames_)
    throw std::logic_error("an animation that has not all of its images");
  write_chunk("IEND", {});
}

} // namespace pmdsim
