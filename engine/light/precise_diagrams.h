#pragma once
// Measured diagrams as the sum in fp64 reads them: at their own angles, each number a pair of floats, all in
// one table.

#include "engine/model/illuminator.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <vector>

namespace pmdsim {

// Each diagram's part: the numbers of thetas and of phis (0 phis where it is the same for all of them); the
// thetas and the phis, in turns, the latter from the first phi on and that again at the end; J, a row of
// thetas for each of these phis. J is 0 below the first theta and beyond the last.
class PreciseDiagrams {
public:
  // The index of the diagram's first number; the same for the same diagram.
  std::uint32_t first_of(const std::shared_ptr<const Diagram> &diagram);

  const std::vector<glm::vec2> &values() const { return values_; }

private:
  std::map<std::shared_ptr<const Diagram>, std::uint32_t> firsts_;
  std::vector<glm::vec2> values_;
};

// The largest error of J, as directions are rounded in fp64; infinite where J is a step.
double precise_diagram_error(const Diagram &diagram);

} // namespace pmdsim
