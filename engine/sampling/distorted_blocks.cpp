#include "engine/lens/lens.h"
#include "engine/sampling/raster_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace pmdsim {
namespace {

constexpr double smallest_cosine = 0.5;      // of a ray to its plane's axis: 60 degrees
constexpr double fragments_per_sample = 3.0; // at most, or the block is cut;
constexpr double spare_fragments = 1 << 16;  // but for so many, which cost less than one more block
constexpr std::uint32_t margin = 3; // fragments: a neighbour, rounding, and the border's bend between pixels
constexpr std::uint32_t largest_samples = 1u << 20; // of a block: as many as a strip has at most
constexpr std::uint32_t smallest_side = 16; // pixels: what is smaller is not cut for its many fragments
constexpr std::uint32_t net = 8;            // steps in which a block is searched for its narrowest samples

// A plane across `axis`, one metre ahead, with a right-handed frame (x right, y down where the axis is the
// camera's).
struct ViewPlane {
  glm::dvec3 x, y, axis;

  explicit ViewPlane(const glm::dvec3 &view_axis) : axis(view_axis) {
    const glm::dvec3 right =
        std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, axis.x > 0 ? -1 : 1);
    x = glm::normalize(right - axis * glm::dot(right, axis));
    y = glm::cross(axis, x);
  }
  glm::dvec2 slope(const glm::dvec3 &ray) const {
    return glm::dvec2(glm::dot(x, ray), glm::dot(y, ray)) / glm::dot(axis, ray);
  }
};

// The rays through the corners of pixels along a block's border, and through a net within it; those that
// there are, as the distortion may fold over in a block, and along the optical axis where there is none.
class BlockRays {
public:
  BlockRays(const Lens &lens, const glm::uvec2 &first, const glm::uvec2 &pixels)
      : lens_(lens), first_(first), pixels_(pixels) {
    for (std::uint32_t column = 0; column <= pixels.x; ++column) {
      add({column, 0});
      add({column, pixels.y});
    }
    for (std::uint32_t row = 0; row <= pixels.y; ++row) {
      add({0, row});
      add({pixels.x, row});
    }
    // The border of a very wide view may lie within 60 degrees of the point behind.
    for (std::uint32_t i = 1; i < net; ++i)
      for (std::uint32_t j = 1; j < net; ++j)
        add(glm::dvec2(pixels * glm::uvec2(i, j)) / static_cast<double>(net));
    if (rays_.empty())
      rays_.emplace_back(0.0, 0.0, 1.0);
  }

  const std::vector<glm::dvec3> &all() const { return rays_; }

  glm::dvec3 mean() const {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3 &ray : rays_)
      sum += ray;
    return glm::normalize(sum);
  }

  // The least width of a pixel on the plane: the smallest singular value of the slopes by the pixels, over
  // the net.
  double narrowest_pixel(const ViewPlane &plane) const {
    double narrowest = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i <= net; ++i)
      for (std::uint32_t j = 0; j <= net; ++j)
        narrowest = std::min(narrowest, pixel_width(plane, glm::dvec2(pixels_ - 1u) * glm::dvec2(i, j) /
                                                               static_cast<double>(net)));
    return narrowest;
  }

private:
  std::optional<glm::dvec3> ray(const glm::dvec2 &pixel) const {
    return lens_.ray(lens_.on_chip_m(glm::dvec2(first_) + pixel));
  }

  void add(const glm::dvec2 &pixel) {
    if (const auto found = ray(pixel))
      rays_.push_back(*found);
  }

  // Infinite where a corner has no ray.
  double pixel_width(const ViewPlane &plane, const glm::dvec2 &pixel) const {
    const auto corner = ray(pixel), right = ray(pixel + glm::dvec2(1, 0)),
               below = ray(pixel + glm::dvec2(0, 1));
    if (!corner || !right || !below)
      return std::numeric_limits<double>::infinity();
    const glm::dvec2 at = plane.slope(*corner);
    const glm::dvec2 a = plane.slope(*right) - at;
    const glm::dvec2 b = plane.slope(*below) - at;
    const double squares = glm::dot(a, a) + glm::dot(b, b), area = a.x * b.y - a.y * b.x;
    const double largest2 = 0.5 * (squares + std::sqrt(std::max(0.0, squares * squares - 4.0 * area * area)));
    return std::abs(area) / std::sqrt(largest2);
  }

  const Lens &lens_;
  glm::dvec2 first_;
  glm::uvec2 pixels_;
  std::vector<glm::dvec3> rays_;
};

class Planner {
public:
  Planner(const Sensor &sensor, std::uint32_t block_fragments)
      : lens_(sensor), samples_(sensor.samples), block_fragments_(block_fragments),
        max_pixels_(largest_samples / (samples_ * samples_)) {}

  void plan(const glm::uvec2 &first, const glm::uvec2 &pixels) {
    const bool small = std::max(pixels.x, pixels.y) <= smallest_side;
    if (pixels.x * pixels.y <= max_pixels_ || small)
      if (const auto block = block_of(first, pixels, small)) {
        blocks_.push_back(*block);
        return;
      }
    if (pixels == glm::uvec2(1))
      throw std::logic_error("a sensor with a pixel that sees too wide a view");
    const bool wide = pixels.x >= pixels.y;
    const glm::uvec2 half = wide ? glm::uvec2(pixels.x / 2, pixels.y) : glm::uvec2(pixels.x, pixels.y / 2);
    const glm::uvec2 step = wide ? glm::uvec2(half.x, 0) : glm::uvec2(0, half.y);
    plan(first, half);
    plan(first + step, pixels - step);
  }

  std::vector<RasterBlock> take() { return std::move(blocks_); }

private:
  // Nothing where the view is too wide, or would take too many fragments; a small block's become wider
  // instead.
  std::optional<RasterBlock> block_of(const glm::uvec2 &first, const glm::uvec2 &pixels, bool small) const {
    const BlockRays rays(lens_, first, pixels);
    const ViewPlane plane(rays.mean());
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::dvec3 &ray : rays.all()) {
      if (glm::dot(ray, plane.axis) < smallest_cosine)
        return std::nullopt;
      low = glm::min(low, plane.slope(ray));
      high = glm::max(high, plane.slope(ray));
    }
    const double samples = static_cast<double>(pixels.x) * pixels.y * samples_ * samples_;
    const glm::dvec2 extent = high - low;
    double scale = samples_ / rays.narrowest_pixel(plane); // fragments per unit of slope
    double largest = std::sqrt((fragments_per_sample * samples + spare_fragments) / (extent.x * extent.y));
    largest = std::min(largest, (block_fragments_ - 2.0 * margin - 1.0) / std::max(extent.x, extent.y));
    if (scale > largest && !small)
      return std::nullopt;
    scale = std::min(scale, largest);
    const glm::dvec2 corner = low * scale - static_cast<double>(margin);
    const glm::dmat3 raster_from_plane(scale, 0, 0, 0, scale, 0, -corner.x, -corner.y, 1);
    return RasterBlock{first, pixels, glm::uvec2(glm::ceil(extent * scale)) + 2u * margin,
                       raster_from_plane * glm::transpose(glm::dmat3(plane.x, plane.y, plane.axis)), true};
  }

  Lens lens_;
  std::uint32_t samples_, block_fragments_, max_pixels_;
  std::vector<RasterBlock> blocks_;
};

} // namespace

std::vector<RasterBlock> distorted_blocks(const Sensor &sensor, std::uint32_t block_fragments) {
  Planner planner(sensor, block_fragments);
  planner.plan(glm::uvec2(0), sensor.resolution);
  return planner.take();
}

} // namespace pmdsim
