#pragma once
// Places that many planes are asked about: does any of them lie above?

#include "engine/view/camera_scene.h"

#include <vector>

namespace pmdsim {

class PlaceSet {
public:
  explicit PlaceSet(std::vector<glm::dvec3> places_m);

  // Whether any place lies more than `margin_m` above the plane, on the side that its normal points to. May
  // say so wrongly once all questions together have cost too much: when many planes hold many of the places.
  bool any_above(const Plane &plane, double margin_m);
  bool any_below(const Plane &plane, double margin_m) {
    return any_above({-plane.normal, -plane.offset_m}, margin_m);
  }

  // The largest sum of a place's absolute coordinates, m, to which rounding is relative.
  double size_m() const { return size_m_; }

private:
  // A box around some of the places; in a leaf they are few.
  struct Node {
    glm::dvec3 low_m, high_m;
    std::size_t first, count; // of the places
    std::size_t second_child; // the first one follows its parent; 0: a leaf
  };

  void add_node(std::size_t first, std::size_t count);
  bool any_above(std::size_t node, const Plane &plane, double margin_m);

  std::vector<glm::dvec3> places_m_;
  std::vector<Node> nodes_;
  double size_m_ = 0.0;
  std::size_t looks_left_;
};

} // namespace pmdsim
