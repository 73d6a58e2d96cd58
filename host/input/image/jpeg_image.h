#pragma once
// JPEG images: 8 bits, grey or colour, baseline or progressive.

#include "host/input/image/image_pixels.h"

namespace pmdsim {

// As decoded_image(). What libjpeg would only warn of, such as an image that is cut short, is an error too.
ImagePixels decoded_jpeg(std::span<const unsigned char> bytes, std::size_t max_pixels, const Place &place);

} // namespace pmdsim
