#pragma once
// Rigid transforms between frames. A transform is named A_from_B: it takes coordinates in frame B to frame A.

#include <glm/glm.hpp>

namespace pmdsim {

// x_a = rotation * x_b + translation_m. `rotation` is orthonormal with determinant +1, `translation_m` is the
// origin of frame B in frame A, in metres.
struct Pose {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation_m{0.0};

  bool operator==(const Pose &) const = default;

  glm::dvec3 point(const glm::dvec3 &p_b) const { return rotation * p_b + translation_m; }
  glm::dvec3 direction(const glm::dvec3 &d_b) const { return rotation * d_b; }
};

inline Pose inverse(const Pose &a_from_b) {
  const glm::dmat3 b_from_a = glm::transpose(a_from_b.rotation);
  return {b_from_a, -(b_from_a * a_from_b.translation_m)};
}

// compose(A_from_B, B_from_C) is A_from_C.
inline Pose compose(const Pose &a_from_b, const Pose &b_from_c) {
  return {a_from_b.rotation * b_from_c.rotation, a_from_b.point(b_from_c.translation_m)};
}

// The camera frame (x right, y down, z forward) in the frame of a glTF node, which looks along its own -Z
// with +Y up.
inline Pose node_from_camera() { return {glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1), glm::dvec3(0)}; }

} // namespace pmdsim
