#include "engine/view/edge_samples.h"

#include "engine/view/cell_rows.h"
#include "engine/view/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace pmdsim {
namespace {

// Fragments by which the grid moves an edge, along either axis, at most: half a step each of a corner and of
// a tile.
constexpr double snapping = 1.0 / 256.0;

// Relative: a ray that meets an edge but for so much meets it, so that both neighbours hold it. More than
// double rounds, and far less than samples lie apart.
constexpr double rounding = 1e-13;
constexpr double depth_slack = 1e-9; // relative

// Takes shapes in the order of their ids: of neighbours whose common edge a ray meets, the first stays.
struct Nearest {
  std::uint32_t id = shader::no_triangle;
  double along = std::numeric_limits<double>::infinity();

  void take(std::uint32_t other, double other_along) {
    if (other_along < along * (1.0 - 10.0 * rounding))
      *this = {other, other_along};
  }
};

// The edges in a block, or in one of its tiles.
class BlockEdges {
public:
  // `shift`: that of the samples from their fragments' centres.
  BlockEdges(const CameraScene &camera, const Scene &scene, const RasterBlock &block, const glm::dvec2 &shift)
      : camera_(camera), scene_(scene), block_(block), shift_(shift),
        camera_from_raster_(glm::inverse(block.raster_from_camera)), near_(block.fragments) {}

  // Calls `take` with column, row and the id of what is seen.
  template <typename Take>
  void decide(const Take &take) {
    for (std::size_t i = 0; i < camera_.triangles.size(); ++i)
      if (!is_disc(i)) // whose rims the raster decides by exact rays
        mark(seen(i).outline);
    const std::uint32_t count = near_.number();
    if (count == 0)
      return;
    solid_.resize(count);
    holed_.resize(count);
    for (std::size_t i = 0; i < camera_.triangles.size(); ++i)
      try_shape(i);
    for (std::int64_t row = 0; row < block_.fragments.y; ++row)
      near_.for_each(row, {0, std::int64_t{block_.fragments.x} - 1},
                     [&](std::uint32_t sample, std::uint32_t column) {
                       if (holed_[sample].along >= solid_[sample].along)
                         take(column, static_cast<std::uint32_t>(row), solid_[sample].id);
                     });
  }

private:
  bool is_disc(std::size_t index) const { return scene_.is_disc(camera_.triangles[index].id); }
  bool is_masked(std::size_t index) const { return scene_.is_masked(camera_.triangles[index].id); }

  // Moved so that samples are in the middles of cells.
  Seen seen(std::size_t index) const {
    Seen seen = seen_in(block_, camera_.triangles[index].corners_m);
    for (std::size_t i = 0; i < seen.outline.count; ++i)
      seen.outline.corners[i] -= shift_;
    return seen;
  }

  void mark(const Outline &outline) {
    for (std::size_t i = 0; i < outline.count; ++i)
      mark(outline.corners[i], outline.corners[i + 1 < outline.count ? i + 1 : 0]);
  }

  // Goes along rows where the edge is steep, else along columns: y counts what is passed, x lies across.
  void mark(glm::dvec2 from, glm::dvec2 to) {
    const bool steep = std::abs(to.y - from.y) >= std::abs(to.x - from.x);
    if (!steep)
      std::tie(from, to) = std::pair(glm::dvec2(from.y, from.x), glm::dvec2(to.y, to.x));
    if (from.y > to.y)
      std::swap(from, to);
    const glm::dvec2 size =
        steep ? glm::dvec2(block_.fragments) : glm::dvec2(block_.fragments.y, block_.fragments.x);
    const double slope = to.y > from.y ? (to.x - from.x) / (to.y - from.y) : 0.0;
    const double last = std::min(std::floor(to.y + snapping - 0.5), size.y - 1.0);
    for (double at = std::max(std::ceil(from.y - snapping - 0.5), 0.0); at <= last; at += 1.0) {
      const double across = from.x + (at + 0.5 - from.y) * slope - 0.5, nearest = std::nearbyint(across);
      if (std::abs(across - nearest) > 2.0 * snapping || !(nearest >= 0.0 && nearest < size.x))
        continue;
      const auto row = static_cast<std::int64_t>(steep ? at : nearest);
      const auto column = static_cast<std::int64_t>(steep ? nearest : at);
      near_.add(row, {column, column});
    }
  }

  void try_shape(std::size_t index) {
    const Seen shape = seen(index);
    const OutlineCells cells(shape.outline, block_.fragments);
    for (std::int64_t row = cells.rows().first; row <= cells.rows().last; ++row)
      near_.for_each(row, cells.touched(row), [&](std::uint32_t sample, std::uint32_t column) {
        const glm::dvec2 place = glm::dvec2(column, row) + 0.5 + shift_;
        const glm::dvec3 ray = camera_from_raster_ * glm::dvec3(place, 1.0); // its length counts depths
        const double along = camera_.planes[index].offset_m / glm::dot(camera_.planes[index].normal, ray);
        if (along >= shape.nearest_m * (1.0 - depth_slack) &&
            along <= shape.farthest_m * (1.0 + depth_slack) &&
            (is_disc(index) ? is_in_disc(index, along * ray) : is_in_triangle(index, ray)))
          (is_masked(index) ? holed_ : solid_)[sample].take(camera_.triangles[index].id, along);
      });
  }

  bool is_in_disc(std::size_t index, const glm::dvec3 &point_m) const {
    const double radius_m = scene_.discs[camera_.triangles[index].id - scene_.triangles.size()].radius_m;
    const glm::dvec3 centre_m = camera_.planes[index].offset_m * camera_.planes[index].normal;
    return glm::distance(point_m, centre_m) <= radius_m;
  }

  bool is_in_triangle(std::size_t index, const glm::dvec3 &ray) const {
    const auto &[a, b, c] = camera_.triangles[index].corners_m;
    const int ab = side_of(ray, a, b), bc = side_of(ray, b, c), ca = side_of(ray, c, a);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  }

  // On which side of the edge from a to b the ray passes, 1 or -1; 0 where it meets it.
  static int side_of(const glm::dvec3 &ray, const glm::dvec3 &a, const glm::dvec3 &b) {
    const double volume = glm::dot(ray, glm::cross(a, b));
    const double zero = rounding * std::sqrt(glm::dot(ray, ray) * glm::dot(a, a) * glm::dot(b, b));
    return volume > zero ? 1 : volume < -zero ? -1 : 0;
  }

  const CameraScene &camera_;
  const Scene &scene_;
  const RasterBlock &block_;
  glm::dvec2 shift_;
  glm::dmat3 camera_from_raster_;
  CellSet near_;                       // the samples near edges
  std::vector<Nearest> solid_, holed_; // of each: the nearest shape that is there, and that may be
};

// Finds the samples of all tiles, in the order of their rows of pixels.
void find_in_block(const CameraScene &camera, const Scene &scene, const Sensor &sensor,
                   const RasterBlock &block, std::vector<shader::EdgeSample> &to) {
  const bool tiled = is_tiled(sensor);
  const std::uint32_t tiles = tiled ? sensor.samples : 1, step = tiled ? sensor.samples : 1;
  const auto first = static_cast<std::ptrdiff_t>(to.size());
  for (std::uint32_t row = 0; row < tiles; ++row)
    for (std::uint32_t column = 0; column < tiles; ++column) {
      const glm::uvec2 tile(column, row), corner = block.first_pixel * sensor.samples + tile;
      BlockEdges(camera, scene, block, sample_shift(sensor, tile))
          .decide([&](std::uint32_t x, std::uint32_t y, std::uint32_t id) {
            to.push_back({corner.x + step * x, corner.y + step * y, id});
          });
    }
  std::stable_sort(to.begin() + first, to.end(),
                   [&](const shader::EdgeSample &a, const shader::EdgeSample &b) {
                     // NOLINTNEXTLINE(clang-analyzer-core.DivideZero): a pixel has a sample
                     return a.row / sensor.samples < b.row / sensor.samples;
                   });
}

} // namespace

EdgeSamples find_edge_samples(const CameraScene &camera, const Scene &scene, const Sensor &sensor,
                              const std::vector<RasterBlock> &blocks) {
  EdgeSamples found;
  for (const RasterBlock &block : blocks) {
    find_in_block(camera, scene, sensor, block, found.samples);
    found.end_of_block.push_back(static_cast<std::uint32_t>(found.samples.size()));
  }
  return found;
}

} // namespace pmdsim
