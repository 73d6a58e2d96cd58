#pragma once
// A plane through the points that the pixels of a window see.

#include "engine/correction/range_image.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>

namespace pmdsim {

struct Window {
  int first_column, last_column, first_row, last_row; // from the pixel
  // A triangle, half of the square: only pixels so many steps from the pixel, columns and rows together.
  int most_steps = std::numeric_limits<int>::max();

  bool has(int column, int row) const { return std::abs(column) + std::abs(row) <= most_steps; }
  // That it takes: a plane through two rows or two columns alone fits whatever lies there.
  int least_count() const {
    const int pixels = (last_column - first_column + 1) * (last_row - first_row + 1);
    return most_steps == std::numeric_limits<int>::max() ? pixels * 3 / 4 + 1 : pixels * 2 / 3;
  }
};

// A plane's g in the frame of the pixel's ray, and how far it may be off.
struct FittedPlane {
  glm::dvec3 g;
  double uncertainty_rad, residual_m;

  glm::dvec3 normal() const { return -glm::normalize(g); }
};

// A pixel in that frame.
struct Point {
  glm::dvec3 direction;
  double range_m;
  glm::dvec3 normal, per_normal_m;

  double range_for_m(const glm::dvec3 &of_plane) const {
    return range_m + glm::dot(per_normal_m, of_plane - normal);
  }
};

// A pixel's ray and what is at right angles to it; camera frame.
struct PixelFrame {
  glm::dvec3 along, across, down;
};

PixelFrame frame_about(const glm::dvec3 &ray);

// Where ranges depend more on their normals, for each distance of neighbouring points, or the normals are a
// guess, windows have a normal in common.
inline constexpr double least_common_gain = 0.35;

// The pixels about one pixel.
class Neighbourhood {
public:
  Neighbourhood(const RangeImage &image, glm::ivec2 at)
      : image_(image), at_(at), frame_(frame_about(image.ray[index(0, 0)])),
        common_normal_(image.normals_guessed ? !image.per_normal_m.empty() : gain() > least_common_gain) {}

  const PixelFrame &frame() const { return frame_; }
  bool is_inside(int column, int row) const {
    const glm::ivec2 p = at_ + glm::ivec2(column, row);
    return p.x >= 0 && p.y >= 0 && p.x < static_cast<int>(image_.resolution.x) &&
           p.y < static_cast<int>(image_.resolution.y);
  }
  bool has(int column, int row) const {
    return is_inside(column, row) && std::isfinite(image_.range_m[index(column, row)]);
  }
  // Whether all pixels up to n to each side have a range that are in the image, and some are not in it.
  bool ends_at_border(int n) const;
  double noise_m() const { return image_.noise_m; }
  double range_m(int column, int row) const { return image_.range_m[index(column, row)]; }
  glm::dvec3 direction(int column, int row) const;
  Point point(int column, int row) const;
  // Whether the ranges of a window are taken for a normal that they have in common.
  bool common_normal() const { return common_normal_; }
  // How far the pixel moves by its normal, for each radian, over the distance of neighbouring points.
  double gain() const;

  template <class Visit>
  void visit(const Window &window, Visit visit) const {
    for (int row = window.first_row; row <= window.last_row; ++row)
      for (int column = window.first_column; column <= window.last_column; ++column)
        if (window.has(column, row) && has(column, row))
          visit(column, row);
  }

private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(at_.y + row) * image_.resolution.x +
           static_cast<std::size_t>(at_.x + column);
  }

  const RangeImage &image_;
  glm::ivec2 at_;
  PixelFrame frame_;
  bool common_normal_;
};

// Range minus that of the plane, to first order.
double residual_m(const Point &point, const FittedPlane &plane);

// Least squares of 1 / r over the points of a window. Nothing where the pixels lie in a line, or are too few.
std::optional<FittedPlane> fitted_plane(const Neighbourhood &around, const Window &window);

} // namespace pmdsim
