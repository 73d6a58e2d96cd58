// PNG and JPEG, as textures and as images of numbers.

#include "tests/fuzz/target.h"

#include "host/input/array/array_formats.h"
#include "host/input/image/image_pixels.h"

using namespace pmdsim;

FUZZ_TARGET(image) {
  constexpr std::size_t most_pixels = 1 << 20;
  const Place place{"image.png"};
  if (fuzz::accepts([&] { linear_texture(decoded_image({data, size}, most_pixels, place)); }))
    fuzz::accepts([&] { png_array(fuzz::text_of(data, size), place); });
  return 0;
}
