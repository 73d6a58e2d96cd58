#pragma once
// Where the diodes of an illuminator are and where they point, in its own frame, and which of them point away
// from all that is seen.

#include "host/input/setup/setup.h"

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

struct BoardFindings {
  glm::dvec3 min_m{0.0}, max_m{0.0}; // of the diodes' places
  double largest_lean_deg = 0.0;     // of their axes, from +z
  // Numbers, from 0, of the diodes whose axes keep their light from all that any sensor sees; none where
  // light bounces or something moves, as others may need it then.
  std::vector<std::size_t> turned_away{};
};

// `seen_m` is what all sensors see, world frame.
BoardFindings board_findings(const Setup &setup, const Illuminator &illuminator,
                             const std::vector<glm::dvec3> &seen_m);

// "x -25 to 25 mm, y -25 to 25 mm, z 0 mm, axes along +z".
std::string board_text(const BoardFindings &board);

// Of the `number`-th illuminator among those of the setup's own camera. Nothing where none of its diodes
// points away, or all of them do, which may be meant.
std::optional<Warning> turned_away_warning(const Setup &setup, std::size_t number,
                                           const BoardFindings &board);

} // namespace pmdsim
