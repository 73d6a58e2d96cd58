#pragma once
// From an image's stored numbers to the light that they mean.

#include "engine/model/scene.h"
#include "host/input/image/image_pixels.h"

namespace pmdsim {

// The sRGB transfer function (IEC 61966-2-1), from 0 ... 1 as stored to linear 0 ... 1.
double linear_from_srgb(double stored);

// Red, green and blue go through the transfer function in double; alpha is linear as stored.
Texture linear_texture(const ImagePixels &pixels);

} // namespace pmdsim
