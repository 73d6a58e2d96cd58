#pragma once
// What the numbers of a measured image mean, and which of them say that nothing was measured.

#include "engine/model/warning.h"
#include "host/input/array/image_array.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

enum class Quantity {
  distance, // c phase / (4 pi f), modulo the ambiguity range or not
  phase,
  depth, // a distance's part along the optical axis
};

// "distance".
std::string_view quantity_name(Quantity quantity);

struct Meaning {
  Quantity quantity = Quantity::distance;
  double unit = 1.0; // metres or radians of 1
};

// What is said of it, and else by the ending of its name, as "distance_m", "phase_rad" or "depth_mm.png".
Meaning meaning_of(std::string_view name, bool whole_numbers, const std::optional<Quantity> &quantity,
                   const std::optional<double> &unit);

// In metres or radians; NaN where nothing was measured: where the image has no number, `invalid`, the largest
// number of an unsigned integer type, or a distance or depth that is not above 0.
std::vector<double> values_of(const ImageArray &array, const Meaning &meaning,
                              const std::optional<double> &invalid);

// That distances seem to be in another unit, or phases. `place` is the image's.
std::vector<Warning> doubts_of_distances(const std::vector<double> &distance_m, double ambiguity_m,
                                         const std::string &place);

} // namespace pmdsim
