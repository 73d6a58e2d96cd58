#pragma once
// How fine elements and lines are for an error, before anything is known of the scene's light.

#include "engine/radiosity/radiosity.h"

#include <vector>

namespace pmdsim {

// Of the error asked for: what elements aim at first.
inline constexpr double first_of_elements = 1.2;

Fineness fineness_of(const Scene &scene, const std::vector<BounceTone> &tones, double error_m);

} // namespace pmdsim
