#pragma once
// Random but repeatable scenes, poses and lights: the same seed gives the same values with every standard
// library.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"

#include <cstdint>
#include <random>

namespace pmdsim::test {

class Random {
public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  double uniform(double lower, double upper);
  // As likely between 1 and 10 as between 10 and 100.
  double log_uniform(double lower, double upper);
  bool flip() { return uniform(0, 1) < 0.5; }
  glm::dvec3 in_box(const glm::dvec3 &lower, const glm::dvec3 &upper);
  glm::dvec3 unit_vector();
  // Any rotation, origin within `reach_m` of the world's.
  Pose pose(double reach_m);

private:
  std::mt19937 engine_; // its values are fixed by the standard, those of the standard's distributions are not
};

// `count` separate triangles, one- and two-sided, of 0.1 to 1 m, in front of the camera: z 0.8 to 3 m, |x|,
// |y| below 1.2 m in its frame.
Scene random_triangles(Random &random, std::size_t count, const Pose &world_from_camera);

// Diodes within 0.25 m of the illuminator's origin, axes within 60 degrees of its +z, isotropic or of orders
// 0 to 30.
Illuminator random_illuminator(Random &random, std::size_t diodes, const Pose &world_from_illuminator);

} // namespace pmdsim::test
