#include "host/input/image/jpeg_image.h"

#include <fmt/format.h>
#include <memory>
#include <new>
#include <turbojpeg.h>

namespace pmdsim {

namespace {

struct Destroy {
  void operator()(void *decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<void, Destroy>;

Error broken(const Decoder &decoder, const Place &place) {
  return input_error(place, fmt::format("no valid JPEG: {}", tjGetErrorStr2(decoder.get())));
}

} // namespace

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

} // namespace pmdsim
