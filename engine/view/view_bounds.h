#pragma once
// Boxes around what is visible.

#include <glm/glm.hpp>

namespace pmdsim {

// Holds what is visible of some consecutive triangles, before one hides another.
struct VisibleBox {
  glm::dvec3 low_m; // camera frame
  glm::dvec3 high_m;
};

} // namespace pmdsim
