#pragma once
// What an image of ranges tells of its noise.

#include "engine/correction/range_image.h"

#include <cstdint>

namespace pmdsim {

// The standard deviation of single ranges, by what is left of the neighbours of a pixel when the part that is
// even about it is taken off, which a curved surface leaves, too. It is found where the image is smoothest,
// in a fifth of it. NaN where no pixel has all eight neighbours.
double noise_of(const RangeImage &image);

// The distance of points of neighbouring pixels, if surfaces faced the lens: the median. NaN likewise.
double spacing_of(const RangeImage &image);

// The least n with which a normal is uncertain by 20 mrad or less, by noise; at most 8.
std::uint32_t fit_pixels_for(double noise_m, double spacing_m);

} // namespace pmdsim
