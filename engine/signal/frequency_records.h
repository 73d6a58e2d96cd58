#pragma once
// How each modulation frequency becomes channels, as the device reads it.

#include "engine/light/tones.h"
#include "engine/model/error_bound.h"

#include <optional>

namespace pmdsim {

// Amplitudes are per unit of the mean return, in which diodes count relative to the strongest.
std::vector<shader::Frequency> frequency_records(const Signal &signal, double largest_intensity_w_sr,
                                                 const std::optional<Promise> &promise);

} // namespace pmdsim
