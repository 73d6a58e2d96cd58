#pragma once
// An order of points, so that what two triangles share is found, and computed with the same bits.

#include <glm/glm.hpp>
#include <tuple>

namespace pmdsim {

inline bool comes_before(const glm::dvec3 &a, const glm::dvec3 &b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

} // namespace pmdsim
