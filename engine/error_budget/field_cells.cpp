#include "engine/error_budget/field_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace pmdsim {

FieldCells::FieldCells(const Sensor &sensor, const FieldGrid &grid, const std::vector<VisibleBox> &visible) {
  const glm::dvec2 pitch = sensor.pixel_pitch_m / sensor.image_distance_m(),
                   edge = 0.5 * pitch * glm::dvec2(sensor.resolution);
  size_ = {static_cast<double>(grid.side) * pitch, 1.0 / grid.cells_m};
  low_ = {-edge, 1.0 / grid.farthest_m};
  high_ = {edge, std::numeric_limits<double>::infinity()};
  for (const VisibleBox &box : visible)
    if (const auto in_frame = seen(box))
      boxes_.push_back(*in_frame);
}

std::optional<FieldCells::SeenBox> FieldCells::seen(const VisibleBox &box) const {
  SeenBox result{box.low_m, box.high_m, 1.0 / box.high_m.z, 1.0 / box.low_m.z, {}, {}};
  // A box beside the axis lies in the frame from some depth on.
  for (int axis = 0; axis < 2; ++axis) {
    if (box.low_m[axis] > 0.0)
      result.most_s = std::min(result.most_s, high_[axis] / box.low_m[axis]);
    if (box.high_m[axis] < 0.0)
      result.most_s = std::min(result.most_s, low_[axis] / box.high_m[axis]);
  }
  if (!(result.most_s >= result.least_s))
    return std::nullopt;
  const glm::dvec3 low = glm::min(box.low_m * result.least_s, box.low_m * result.most_s),
                   high = glm::max(box.high_m * result.least_s, box.high_m * result.most_s);
  result.low = {glm::max(glm::dvec2(low), glm::dvec2(low_)), result.least_s};
  result.high = {glm::min(glm::dvec2(high), glm::dvec2(high_)), result.most_s};
  return result;
}

CellCorners FieldCells::corners_m() const {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const SeenBox &box : boxes_) {
    low = glm::min(low, box.low);
    high = glm::max(high, box.high);
  }
  // Cells that touch no more than an edge count as well, but for those beyond the frame.
  const glm::dvec3 cells = glm::ceil((high_ - low_) / size_),
                   first = low_ + size_ * glm::max(glm::ceil((low - low_) / size_) - 1.0, 0.0),
                   last = low_ + size_ * glm::min(glm::floor((high - low_) / size_) + 1.0, cells);
  CellCorners corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = over_depth(glm::mix(first, last, glm::bvec3((i & 1) != 0, (i & 2) != 0, (i & 4) != 0)));
  return corners;
}

double FieldCells::count() const {
  const glm::dvec2 across = glm::ceil(glm::dvec2(high_ - low_) / glm::dvec2(size_));
  double met = 0.0, nearest = low_.z;
  for (const SeenBox &box : boxes_) {
    const glm::dvec3 extent = (box.high - box.low) / size_;
    met += extent.x * extent.y * (1.0 + extent.z / std::max({extent.x, extent.y, 1.0}));
    nearest = std::max(nearest, box.most_s);
  }
  const double columns = across.x * across.y, layers = 1.0 + std::floor((nearest - low_.z) / size_.z);
  return std::clamp(met, columns, layers * columns);
}

glm::dvec3 FieldCells::place_m(const SeenBox &box, const glm::dvec3 &within) const {
  const double s = glm::mix(box.least_s, box.most_s, within.z);
  const glm::dvec2 low_m = glm::max(glm::dvec2(box.low_m), glm::dvec2(low_) / s),
                   high_m = glm::min(glm::dvec2(box.high_m), glm::dvec2(high_) / s);
  return {glm::mix(low_m, high_m, glm::dvec2(within)), 1.0 / s};
}

std::vector<const FieldCells::SeenBox *> FieldCells::boxes_to_look_at() const {
  constexpr std::size_t most_boxes = 24;
  std::vector<const SeenBox *> boxes;
  double nearest = low_.z;
  for (const SeenBox &box : boxes_)
    nearest = std::max(nearest, box.most_s);
  // The farthest ones towards each corner, near and far.
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) {
        const glm::dvec3 towards(x / high_.x, y / high_.y, z / nearest);
        const auto reach = [&](const SeenBox &box) {
          const glm::dvec3 most = glm::max(box.low * towards, box.high * towards);
          return most.x + most.y + most.z;
        };
        if (!boxes_.empty())
          boxes.push_back(&*std::ranges::max_element(boxes_, {}, reach));
      }
  const std::size_t step = (boxes_.size() + most_boxes - 1) / most_boxes;
  for (std::size_t i = 0; i < boxes_.size(); i += step)
    boxes.push_back(&boxes_[i]);
  std::ranges::sort(boxes);
  boxes.erase(std::ranges::unique(boxes).begin(), boxes.end());
  return boxes;
}

std::vector<glm::dvec3> FieldCells::corner_places_m() const {
  std::vector<glm::dvec3> all;
  for (const SeenBox *box : boxes_to_look_at())
    for (const double x : {0.001, 0.999})
      for (const double y : {0.001, 0.999})
        for (const double z : {0.001, 0.999})
          all.push_back(place_m(*box, {x, y, z}));
  return all;
}

std::vector<glm::dvec3> FieldCells::random_places_m() const {
  constexpr std::size_t most_places = 160;
  std::mt19937 random(1);
  const auto part = [&] { return std::generate_canonical<double, 32>(random); };
  std::vector<glm::dvec3> all;
  const std::vector<const SeenBox *> boxes = boxes_to_look_at();
  for (const SeenBox *box : boxes)
    for (std::size_t k = 0; k < most_places / boxes.size(); ++k) {
      const double x = part(), y = part(), z = part();
      all.push_back(place_m(*box, {x, y, z}));
    }
  return all;
}

ViewCell FieldCells::cell_of(const glm::dvec3 &place_m) const {
  const glm::dvec3 number = glm::max(glm::floor((over_depth(place_m) - low_) / size_), 0.0);
  return {low_ + (number + 0.5) * size_, 0.5 * size_};
}

} // namespace pmdsim
