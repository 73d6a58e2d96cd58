#pragma once
// A square in space, and where a ray from the lens meets it, both by hand.

#include "engine/model/scene.h"
#include "tests/comparison/engines.h"

namespace pmdsim::test {

// Camera frame. Seen from both sides.
struct Square {
  glm::dvec3 centre_m;
  glm::dvec3 normal; // of any length
  double half_side_m = 10.0;
};

Scene scene_of(const Square &square);

// Where the ray from the lens towards `place` meets the square's plane.
glm::dvec3 meeting_point_m(const Square &square, const glm::dvec3 &place);

// Range, z and (under monostatic light) distance of a pixel that sees one point.
void check_point(Engine engine, const std::string &name, const glm::dvec3 &true_m, const Sensor &sensor,
                 const Measurement &measured, std::size_t pixel);

} // namespace pmdsim::test
