#pragma once
// The cells of the view in which sums are interpolated (engine/view/field_grid.h), as far as anything is seen
// in them. A place is (x, y, 1) / s in the camera's frame: its ray, and the inverse of its depth.

#include "engine/model/sensor.h"
#include "engine/view/camera_scene.h"
#include "engine/view/field_grid.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace pmdsim {

// From x, y and s to the place, and back.
inline glm::dvec3 over_depth(const glm::dvec3 &at) { return glm::dvec3(at.x, at.y, 1.0) / at.z; }

// Of x, y and s: its middle, and half of its extent along each.
struct ViewCell {
  glm::dvec3 middle, half;

  glm::dvec3 place_m(const glm::dvec3 &within) const { // each in [-1, 1]
    return over_depth(middle + half * within);
  }
};

// The corners of some cells together, between which their nodes lie.
using CellCorners = std::array<glm::dvec3, 8>;

class FieldCells {
public:
  // `visible`: in front of the lens.
  FieldCells(const Sensor &sensor, const FieldGrid &grid, const std::vector<VisibleBox> &visible);

  // Whether anything is in the frame.
  bool any() const { return !boxes_.empty(); }
  // Of the cells in which anything may be seen, all together.
  CellCorners corners_m() const;
  // How many of them there are, about, where a surface crosses the cells of its box once.
  double count() const;
  // Places that may be seen, of 32 boxes at the most, those at the frame's corners among them: the boxes'
  // corners, and at random, even in s.
  std::vector<glm::dvec3> corner_places_m() const;
  std::vector<glm::dvec3> random_places_m() const;
  ViewCell cell_of(const glm::dvec3 &place_m) const;

private:
  // A box as far as it lies in the frame.
  struct SeenBox {
    glm::dvec3 low_m, high_m;
    double least_s, most_s;
    glm::dvec3 low, high; // of x, y and s
  };

  std::optional<SeenBox> seen(const VisibleBox &box) const;
  std::vector<const SeenBox *> boxes_to_look_at() const;
  glm::dvec3 place_m(const SeenBox &box, const glm::dvec3 &within) const; // each in [0, 1]

  glm::dvec3 size_;       // of a cell
  glm::dvec3 low_, high_; // of the frame's x and y, and of s
  std::vector<SeenBox> boxes_;
};

} // namespace pmdsim
