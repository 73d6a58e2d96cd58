#pragma once
// Curves and points over two axes.

#include "host/output/pictures/canvas.h"
#include "host/output/tables/diode_study.h"
#include "host/output/tables/noise.h"
#include "host/output/tables/tradeoff.h"

#include <glm/glm.hpp>
#include <span>
#include <string>

namespace pmdsim {

// The profile through the middle of a frame: one float channel against the column; gaps where it is NaN.
Canvas draw_profile(std::span<const float> values, const glm::uvec2 &resolution, const std::string &quantity,
                    const std::string &unit, const std::string &title);

// Speed against accuracy: the largest error beside edges against frame time, both logarithmic, with the
// fronts.
Canvas draw_tradeoff(const Tradeoff &tradeoff);

// Noise of distances against distance, and variance against mean of a tap: predicted lines, dots as found.
Canvas draw_precision(const NoiseStudy &study);
Canvas draw_transfer(const NoiseStudy &study);

// The diodes at their places, by their part in what boards differ by.
Canvas draw_diodes(const DiodeStudy &study);

} // namespace pmdsim
