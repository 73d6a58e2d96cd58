#pragma once
// Measured diagrams as the accumulate pass reads them: on even grids, all in one table.

#include "engine/illuminator.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <vector>

namespace pmdsim {

// A diagram on an even grid: linear in the steps of both angles, 0 below the first theta and beyond the last.
struct DiagramGrid {
  std::uint32_t first_value = 0; // index into the table; the values of a phi are a row
  double first_theta_rad = 0.0;
  double theta_steps_per_rad = 0.0;
  std::uint32_t theta_steps = 0; // one more value than these
  double first_phi_rad = 0.0;
  // That a turn has; the row after the last is the first again. 0: one row for all phi.
  std::uint32_t phi_steps = 0;
};

class DiagramTables {
public:
  // The same grid for the same diagram.
  DiagramGrid grid_of(const std::shared_ptr<const Diagram> &diagram);

  // Each value with the next theta's.
  const std::vector<glm::vec2> &values() const { return values_; }

private:
  std::map<std::shared_ptr<const Diagram>, DiagramGrid> grids_;
  std::vector<glm::vec2> values_;
};

} // namespace pmdsim
