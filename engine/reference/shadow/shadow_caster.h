#pragma once
// Which diodes nothing hides from a point that the lens sees. Whether a shape near the way blocks it is
// decided in double from the exact places of shape, point and diode.

#include "engine/reference/light/light_paths.h"
#include "engine/reference/view/shape_tree.h"

#include <cstdint>
#include <vector>

namespace pmdsim::reference {

// A point or a diode, camera frame.
struct Place {
  glm::dvec3 position_m;
  double range_m; // from the lens
};

// A shape's plane, and how far from it rounding may put a place that lies on it.
struct ShapePlane {
  glm::dvec3 normal; // of any length
  double offset;
  double rounding; // of a height above the plane, a metre of the ranges that went into it
  double range_m;

  // 1 in front, -1 behind, 0 where rounding may have put a place that touches the plane.
  int side_of(const Place &place) const;
};

// A triangle or a disc.
template <class Shape>
struct Blocker {
  Shape shape;
  ShapePlane plane;
};

struct ShadowQuery;

class ShadowCaster {
public:
  // Positions have been rounded where the world's origin is `origin_range_m` away. `is_there` is asked about
  // cutouts shapes only. Throws Error: out_of_memory.
  ShadowCaster(const std::vector<CameraTriangle> &triangles, const std::vector<CameraDisc> &discs,
               const std::vector<Light> &lights, double origin_range_m, IsThere is_there = {});

  // The diodes in front of the surface at `point` with no shape but its own, `id`, in their way, whichever
  // side the shape shows. No way leads through the edge that two triangles share, and what touches the point
  // or the diode does not block. Any number of threads may call this at once.
  DiodeSet reached(const SurfacePoint &point, std::uint32_t id) const;

private:
  friend ShadowQuery;
  bool is_blocked(ShadowQuery &query) const;

  std::vector<Blocker<CameraTriangle>> triangles_;
  std::vector<Blocker<CameraDisc>> discs_;
  std::vector<Place> diodes_;
  IsThere is_there_;
  ShapeTree tree_;
};

} // namespace pmdsim::reference
