#pragma once
// Measured diagrams as the accumulate pass reads them: on even grids, all in one table.

#include "engine/model/illuminator.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <vector>

namespace pmdsim {

// A diagram's part of the table; J is 0 below the first theta and beyond the last. Where it is the same for
// all phi: J on an even grid of theta, linear between. Else three parts, one behind the other: on an even
// grid of theta which of the diagram's own angles (a fraction between two) it is, likewise of phi, and J at
// its own angles, a row of thetas for each phi, the first two again at the end.
struct DiagramGrid {
  std::uint32_t first_value = 0; // index into the table
  double first_theta_rad = 0.0;
  double theta_steps_per_rad = 0.0;
  std::uint32_t theta_steps = 0; // one more value than these
  double first_phi_rad = 0.0;
  std::uint32_t phi_steps = 0;  // that a turn has
  std::uint32_t row_length = 0; // angles to the axis; 0: the same for all phi
  double error = 0.0;           // of J, at most, as the even grid makes it
};

// J at an angle to the axis and one about it, 0 to 2 pi; 0 where the diagram has none.
double relative_at(const Diagram &diagram, double theta_rad, double phi_rad);

// The largest change of J where each angle is off by a part of itself, over that part: pi |dJ/dtheta| +
// |dJ/dphi| / sin theta, the latter as directions near the axis are uncertain in phi. Infinite where J varies
// about the axis itself. Where a table ends it may jump to 0; that is an edge like a shadow's.
double diagram_slope(const Diagram &diagram);

// The largest error of J as it is found on the grid in float, with what rounding takes from the direction;
// `radius_over_range` as in SourceGroups. Infinite where J is a step.
double diagram_error(const Diagram &diagram, const DiagramGrid &grid, double radius_over_range);

class DiagramTables {
public:
  // Returns the same grid for the same diagram.
  DiagramGrid grid_of(const std::shared_ptr<const Diagram> &diagram);

  // Each value with the next one.
  const std::vector<glm::vec2> &values() const { return values_; }

private:
  std::map<std::shared_ptr<const Diagram>, DiagramGrid> grids_;
  std::vector<glm::vec2> values_;
};

} // namespace pmdsim
