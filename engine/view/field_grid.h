#pragma once
// Cells of the view in which the light's field is interpolated (engine/light/host/incident_field.h): square
// in the frame, even in the inverse of the depth.

#include "engine/model/exponent.h"

#include <cstddef>
#include <cstdint>
#include <numbers>

namespace pmdsim {

// The nodes of a cell along columns, rows and depth: Chebyshev's, stretched so that the last ones lie at the
// cell's ends. What the nodes are off by then grows to less than 1.43 times along each axis, not to 1.85
// times.
inline constexpr std::size_t field_nodes = 4;
inline constexpr double field_node_places[field_nodes] = {-1.0, 1.0 - std::numbers::sqrt2,
                                                          std::numbers::sqrt2 - 1.0, 1.0};
// Lambert's surfaces that take it are so high under the sources' reference point, in radii of the sources
// about it: the interpolated sums cancel the less, the higher.
inline constexpr double field_height = 3.0;

// What a run's sums are divided by before they are interpolated: the beam of a source at the run's reference
// point, so that what is left of narrow beams changes slowly, too. It is cos^power of the angle to the axis.
struct FieldBeam {
  double axis[3]; // camera frame
  Exponent power; // 0: sums are interpolated as they are
};

struct FieldGrid {
  std::uint32_t side; // of a cell, samples
  double cells_m;     // of a unit of the inverse depth, 1 / m
  double farthest_m;  // depth at which the first cell begins
};

} // namespace pmdsim
