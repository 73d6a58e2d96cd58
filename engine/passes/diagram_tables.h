#pragma once
// Measured diagrams as the accumulate pass reads them: on even grids, all in one table.

#include "engine/illuminator.h"

#include <cstdint>
#include <map>
#include <vector>

namespace pmdsim {

// A diagram's grid. Its values are linear in the steps of both angles, 0 below no step and beyond the last.
struct DiagramGrid {
  std::uint32_t first_value = 0; // index into the table; the values of a theta lie side by side
  double first_theta_rad = 0.0;
  double theta_steps_per_rad = 0.0;
  std::uint32_t theta_steps = 0; // one more value than these
  double first_phi_rad = 0.0;
  std::uint32_t phi_steps =
      0; // a turn has; the value after the last is the first again. 0: one value for all phi
};

class DiagramTables {
public:
  // The same grid for the same diagram.
  DiagramGrid grid_of(const std::shared_ptr<const Diagram> &diagram);

  const std::vector<float> &values() const { return values_; }

private:
  std::map<std::shared_ptr<const Diagram>, DiagramGrid> grids_;
  std::vector<float> values_;
};

} // namespace pmdsim
