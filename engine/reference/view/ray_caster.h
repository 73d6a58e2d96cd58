#pragma once
// The shape that a ray from the lens sees first. Which of the triangles and discs near the ray it hits, and
// which is nearest, is decided in double from the shape's exact place and the ray's exact direction.

#include "engine/reference/view/camera_frame.h"
#include "engine/reference/view/shape_tree.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace pmdsim::reference {

struct Hit {
  std::uint32_t id; // of a triangle, or the number of triangles and a disc's index
  double range_m;   // from the lens, along the ray
};

class RayCaster {
public:
  // `is_there` is asked about cutouts shapes only. Throws Error: out_of_memory.
  explicit RayCaster(std::vector<CameraTriangle> triangles, std::vector<CameraDisc> discs = {},
                     IsThere is_there = {});

  // The nearest triangle along `direction` (unit length) whose face the lens can see, or disc; the lowest id
  // where several are equally near. A ray through the edge that two triangles share hits one of them. Any
  // number of threads may call this at once.
  std::optional<Hit> nearest(const glm::dvec3 &direction) const;

  // How much each corner of the shape that `direction` hits counts there.
  glm::dvec3 weights(const glm::dvec3 &direction, std::uint32_t id) const;
  // Unit length, turned to the lens, which looks along `direction`.
  glm::dvec3 normal(const glm::dvec3 &direction, std::uint32_t id) const;

  const std::vector<CameraTriangle> &triangles() const { return triangles_; }
  const std::vector<CameraDisc> &discs() const { return discs_; }

private:
  std::vector<CameraTriangle> triangles_;
  std::vector<CameraDisc> discs_;
  IsThere is_there_;
  ShapeTree tree_;
};

// The distance along `direction` (unit length) from the lens to where it passes through `triangle`, edges
// included; nothing where it misses, runs in the triangle's plane or meets a face that the lens cannot see.
std::optional<double> range_along(const glm::dvec3 &direction, const CameraTriangle &triangle);
// The same for a disc, its rim included.
std::optional<double> range_along(const glm::dvec3 &direction, const CameraDisc &disc);

} // namespace pmdsim::reference
