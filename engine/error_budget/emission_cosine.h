#pragma once
// How far off their axes diodes shine at what is visible.

#include "engine/light/source_groups.h"
#include "engine/view/camera_scene.h"

#include <vector>

namespace pmdsim {

inline constexpr double grazing_cosine = 0.01;

// For RoundingScope: a lower bound of the emission cosine over all that is visible, but at least
// grazing_cosine. Pixels with a smaller one have no bound.
double least_emission_cosine(const SourceGroups &groups, const std::vector<VisibleBox> &visible);

} // namespace pmdsim
