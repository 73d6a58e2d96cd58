#include "engine/view/rim_cells.h"

#include "engine/view/cell_rows.h"
#include "engine/view/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace pmdsim {
namespace {

constexpr double slack = 1e-5;              // relative, of depths, which the search compares in float
constexpr double reach = 0.5 + cell_margin; // fragments, of a cell from its middle
constexpr std::size_t candidates_at_most = 1u << 14; // of a cell: a loop that lavapipe does not end early

using Corners = std::array<glm::dvec3, 3>;

Corners corners_of(const shader::TriangleCorners &record) {
  Corners corners_m;
  for (std::size_t k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const glm::dvec2 pair(record.corners[3 * k + static_cast<std::size_t>(axis)]);
      corners_m[k][axis] = pair.x + pair.y;
    }
  return corners_m;
}

// The corner of `triangle` across from the edge beyond which `from` lies.
std::optional<glm::dvec3> corner_across(const shader::TriangleCorners &triangle, std::uint32_t from) {
  for (std::size_t side = 0; side < 3; ++side)
    if (triangle.beyond[side] == from)
      return corners_of(triangle)[(side + 2) % 3];
  return std::nullopt;
}

// Whether the lens does not see the surface go on beyond a side of a triangle.
bool is_rim(const std::vector<shader::TriangleCorners> &all, std::uint32_t id, std::size_t side) {
  const std::uint32_t beyond = all[id].beyond[side];
  if (beyond == shader::no_triangle)
    return true;
  const auto theirs_m = corner_across(all[beyond], id);
  if (!theirs_m) // three share the edge
    return true;
  const Corners corners_m = corners_of(all[id]);
  const glm::dvec3 through_edge = glm::cross(corners_m[side], corners_m[(side + 1) % 3]);
  const double own = glm::dot(through_edge, corners_m[(side + 2) % 3]),
               other = glm::dot(through_edge, *theirs_m);
  return !((own > 0.0 && other < 0.0) || (own < 0.0 && other > 0.0));
}

// The depths of a shape in a cell. One over the depth is affine on the raster.
class DepthsInCells {
public:
  DepthsInCells(const Seen &shape, const Plane &plane, const glm::dmat3 &camera_from_raster)
      : nearest_m_(shape.nearest_m), farthest_m_(shape.farthest_m),
        inverse_(glm::transpose(camera_from_raster) * plane.normal / plane.offset_m),
        spread_(reach * (std::abs(inverse_.x) + std::abs(inverse_.y))) {}

  struct Depths {
    double near_m, far_m;
  };
  Depths of(const glm::dvec2 &cell) const {
    const double middle = glm::dot(inverse_, glm::dvec3(cell + 0.5, 1.0));
    return {std::clamp(1.0 / std::max(0.0, middle + spread_), nearest_m_, farthest_m_) * (1.0 - slack),
            std::clamp(1.0 / std::max(0.0, middle - spread_), nearest_m_, farthest_m_) * (1.0 + slack)};
  }

private:
  double nearest_m_, farthest_m_;
  glm::dvec3 inverse_; // 1/m: of (x, y, 1)
  double spread_;
};

// A rim that is an edge.
struct Side {
  glm::dvec3 from_m, to_m;
};

std::vector<Side> rims_of(const CameraScene &camera, const Scene &scene,
                          const std::vector<shader::TriangleCorners> &corners) {
  std::vector<Side> rims;
  for (const auto &[corners_m, id] : camera.triangles)
    for (std::size_t side = 0; side < 3 && id < scene.triangles.size(); ++side)
      if (is_rim(corners, id, side))
        rims.push_back({corners_m[side], corners_m[(side + 1) % 3]});
  return rims;
}

// The rims of a block.
class BlockRims {
public:
  BlockRims(const CameraScene &camera, const Scene &scene, const RasterBlock &block)
      : camera_(camera), scene_(scene), block_(block),
        camera_from_raster_(glm::inverse(block.raster_from_camera)), cells_(block.fragments) {}

  void find(const std::vector<Side> &sides, RimCells &to) {
    for (const Side &side : sides)
      add_side(side);
    for (std::size_t i = 0; i < camera_.triangles.size(); ++i)
      if (is_disc(i) || is_masked(i))
        add_shape(i);
    far_m_.assign(cells_.number(), std::numeric_limits<double>::infinity());
    if (!far_m_.empty())
      for (const auto &[nearest_m, index] : nearest_first())
        add_candidates(index);
    store(to);
  }

private:
  struct Found {
    std::uint32_t cell;
    shader::RimCandidate candidate;
  };

  bool is_disc(std::size_t index) const { return scene_.is_disc(camera_.triangles[index].id); }
  bool is_masked(std::size_t index) const { return scene_.is_masked(camera_.triangles[index].id); }
  Seen seen(std::size_t index) const { return seen_in(block_, camera_.triangles[index].corners_m); }

  void add_side(const Side &side) {
    const OutlineCells line(seen_in(block_, std::array{side.from_m, side.to_m}).outline, block_.fragments);
    for (std::int64_t row = line.rows().first; row <= line.rows().last; ++row)
      cells_.add(row, line.touched(row));
  }

  // Adds all cells that the shape touches, but for those within a disc.
  void add_shape(std::size_t index) {
    const bool whole = is_masked(index);
    const OutlineCells shape(seen(index).outline, block_.fragments);
    for (std::int64_t row = shape.rows().first; row <= shape.rows().last; ++row) {
      const CellSpan columns = shape.touched(row);
      for (std::int64_t column = columns.first; column <= columns.last; ++column)
        if (whole || !is_within_disc(index, row, column))
          cells_.add(row, {column, column});
    }
  }

  bool is_within_disc(std::size_t index, std::int64_t row, std::int64_t column) const {
    const Plane &plane = camera_.planes[index];
    const double radius_m =
        scene_.discs[camera_.triangles[index].id - scene_.triangles.size()].radius_m * (1.0 - slack);
    const double distance2 = plane.offset_m * plane.offset_m;
    const glm::dvec2 middle(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    for (const double x : {-reach, reach})
      for (const double y : {-reach, reach}) {
        const glm::dvec3 ray = camera_from_raster_ * glm::dvec3(middle + glm::dvec2(x, y), 1.0);
        const double along = -glm::dot(plane.normal, ray);
        if (!(along > 0.0 &&
              along * along * (distance2 + radius_m * radius_m) >= distance2 * glm::dot(ray, ray)))
          return false;
      }
    return true;
  }

  // The shapes that may touch cells with rims, in an order in which those behind are mostly found to be
  // hidden.
  std::vector<std::pair<double, std::size_t>> nearest_first() const {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < camera_.triangles.size(); ++i) {
      const Seen shape = seen(i);
      const OutlineCells around(shape.outline, block_.fragments);
      bool touches = false;
      for (std::int64_t row = around.rows().first; row <= around.rows().last && !touches; ++row)
        touches = cells_.has_any(row, around.columns());
      if (touches)
        order.emplace_back(shape.nearest_m, i);
    }
    std::ranges::sort(order);
    return order;
  }

  void add_candidates(std::size_t index) {
    const Seen shape = seen(index);
    const DepthsInCells depths(shape, camera_.planes[index], camera_from_raster_);
    const bool hides = !is_disc(index) && !is_masked(index);
    const OutlineCells outline(shape.outline, block_.fragments);
    for (std::int64_t row = outline.rows().first; row <= outline.rows().last; ++row) {
      const CellSpan touched = outline.touched(row);
      const CellSpan inside = hides && touched.last - touched.first >= 2 ? outline.inside(row) : CellSpan();
      cells_.for_each(row, touched, [&](std::uint32_t cell, std::uint32_t column) {
        const auto [near_m, far_m] = depths.of({column, row});
        if (near_m > far_m_[cell])
          return;
        found_.push_back({cell, {camera_.triangles[index].id, static_cast<float>(near_m)}});
        if (column >= inside.first && column <= inside.last)
          far_m_[cell] = std::min(far_m_[cell], far_m);
      });
    }
  }

  // Cell by cell, and the candidates of each in their order.
  void store(RimCells &to) {
    std::erase_if(found_, [&](const Found &found) { return found.candidate.depth_m > far_m_[found.cell]; });
    std::vector<std::size_t> ends(far_m_.size() + 1);
    for (const Found &found : found_)
      ++ends[found.cell + 1];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<shader::RimCandidate> sorted(found_.size());
    for (const Found &found : found_)
      sorted[--ends[found.cell + 1]] = found.candidate;
    ends.push_back(sorted.size());
    for (std::int64_t row = 0; row < block_.fragments.y; ++row)
      cells_.for_each(row, {0, std::int64_t{block_.fragments.x} - 1},
                      [&](std::uint32_t cell, std::uint32_t column) {
                        store({static_cast<std::uint32_t>(row) * block_.fragments.x + column, 0},
                              std::span(sorted).subspan(ends[cell + 1], ends[cell + 2] - ends[cell + 1]), to);
                      });
  }

  void store(shader::RimCell cell, std::span<shader::RimCandidate> candidates, RimCells &to) const {
    std::ranges::sort(candidates, [](const shader::RimCandidate &a, const shader::RimCandidate &b) {
      return std::tie(a.depth_m, a.shape) < std::tie(b.depth_m, b.shape);
    });
    cell.first_candidate = static_cast<std::uint32_t>(to.candidates.size());
    to.cells.push_back(cell);
    const auto kept = candidates.first(std::min(candidates.size(), candidates_at_most));
    to.candidates.insert(to.candidates.end(), kept.begin(), kept.end());
    to.candidates.push_back({shader::no_triangle, 0.0f});
  }

  const CameraScene &camera_;
  const Scene &scene_;
  const RasterBlock &block_;
  glm::dmat3 camera_from_raster_;
  CellSet cells_;
  std::vector<double> far_m_; // of each cell: what lies behind is hidden all over it
  std::vector<Found> found_;
};

} // namespace

RimCells find_rim_cells(const CameraScene &camera, const Scene &scene,
                        const std::vector<shader::TriangleCorners> &corners,
                        const std::vector<RasterBlock> &blocks) {
  const std::vector<Side> sides = rims_of(camera, scene, corners);
  RimCells cells;
  for (const RasterBlock &block : blocks) {
    BlockRims(camera, scene, block).find(sides, cells);
    cells.end_of_block.push_back(static_cast<std::uint32_t>(cells.cells.size()));
  }
  return cells;
}

} // namespace pmdsim
