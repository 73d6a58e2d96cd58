#pragma once
// The profile through the middle of a frame as a plot.

#include "host/output/pictures/canvas.h"

#include <glm/glm.hpp>
#include <span>
#include <string>

namespace pmdsim {

// One float channel against the column; gaps where it is NaN.
Canvas draw_profile(std::span<const float> values, const glm::uvec2 &resolution, const std::string &quantity,
                    const std::string &unit, const std::string &title);

} // namespace pmdsim
