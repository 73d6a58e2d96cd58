#pragma once
// PNG images: every colour type and depth, tRNS, interlaced or not.

#include "host/input/image/image_pixels.h"

namespace pmdsim {

// As decoded_image().
ImagePixels decoded_png(std::span<const unsigned char> bytes, std::size_t max_pixels, const Place &place);

} // namespace pmdsim
