#pragma once
// What is seen along one line over a hemisphere: coordinates in its half plane are x along the axis and y
// above the surface, angles count from x.

#include "engine/surfaces/hemisphere_scan.h"
#include "engine/surfaces/surface_frame.h"

#include <array>
#include <bit>
#include <cstring>

namespace pmdsim {

struct StretchEnd {
  glm::vec2 at_m;
  glm::vec3 weights; // of the triangle's corners
  float angle;
};

// What a triangle is on a line.
struct Stretch {
  StretchEnd low, high; // by angle, once it is added
  std::uint32_t triangle;
  std::uint8_t side;
};

// The part of a stretch that is seen. Where it takes more of the line than it covers, as other small ones
// beside it take less, shares are to be scaled.
struct SeenRun {
  StretchEnd from, to;
  float scale;
};

inline StretchEnd between(const StretchEnd &a, const StretchEnd &b, float t) {
  return {a.at_m + t * (b.at_m - a.at_m), a.weights + t * (b.weights - a.weights), 0.0f};
}

// The nearest stretch in each direction: of a row of bins, each of which asks in its middle. Where seen
// stretches end is known better than bins do.
class LineSight {
public:
  void clear() {
    stretches_.clear();
    nearness_.fill(0.0f);
    nearest_.fill(none);
  }

  // Adds what lies above `lowest_m` and where is_there(weights of corners).
  template <class IsThere>
  void add(Stretch stretch, float lowest_m, const IsThere &is_there) {
    if (!clip(stretch, lowest_m))
      return;
    auto &[low, high, triangle, side] = stretch;
    low.angle = angle_of(low.at_m.x, low.at_m.y);
    high.angle = angle_of(high.at_m.x, high.at_m.y);
    if (low.angle > high.angle)
      std::swap(low, high);
    const float area = cross(low.at_m, high.at_m);
    const std::uint32_t first = first_bin(low.angle), end = first_bin(high.angle);
    if (!(area > 0.0f) || first >= end)
      return;
    const auto own = static_cast<std::int32_t>(stretches_.size());
    stretches_.push_back(stretch);
    // 1 / length, which is linear in the direction.
    const float of_x = (high.at_m.y - low.at_m.y) / area, of_y = (low.at_m.x - high.at_m.x) / area;
    const Directions &directions = LineSight::directions();
    for (std::uint32_t i = first; i < end; ++i) {
      const float nearness = of_x * directions.x[i] + of_y * directions.y[i];
      const bool is_nearer = nearness > nearness_[i] &&
                             is_there(CornerWeights(weights_at(stretch, {directions.x[i], directions.y[i]})));
      nearness_[i] = is_nearer ? nearness : nearness_[i];
      nearest_[i] = is_nearer ? own : nearest_[i];
    }
  }

  // Calls visit(stretch, its part that is seen), in the order of angles.
  template <class Visit>
  void for_each_run(const Visit &visit) const {
    std::array<std::uint8_t, bins> changes;
    for (std::size_t i = 0; i < bins; ++i)
      changes[i] = nearest_[i] != nearest_[i + 1] ? 1 : 0;
    std::int32_t seen = nearest_[0];
    float from = seen == none ? 0.0f : border(none, seen, 0);
    for (std::uint32_t eight = 0; eight < bins; eight += 8) {
      std::uint64_t bits;
      std::memcpy(&bits, &changes[eight], sizeof bits);
      for (; bits != 0; bits &= bits - 1) {
        const std::uint32_t i = eight + static_cast<std::uint32_t>(std::countr_zero(bits)) / 8 + 1;
        const float to = border(seen, nearest_[i], i);
        if (seen != none && to > from)
          visit(stretch(seen), part_of(stretch(seen), from, to));
        seen = nearest_[i];
        from = to;
      }
    }
  }

private:
  static constexpr std::size_t bins = 256;
  static constexpr float bin_rad = std::numbers::pi_v<float> / bins;
  static constexpr std::int32_t none = -1;

  // The middles of bins.
  struct Directions {
    alignas(64) std::array<float, bins> x, y;
    Directions() {
      for (std::size_t i = 0; i < bins; ++i) {
        const double angle = std::numbers::pi * (static_cast<double>(i) + 0.5) / bins;
        x[i] = static_cast<float>(std::cos(angle));
        y[i] = static_cast<float>(std::sin(angle));
      }
    }
  };
  static const Directions &directions() {
    static const Directions made;
    return made;
  }

  // The first whose middle is not before that angle.
  static std::uint32_t first_bin(float angle) {
    const float bin = std::ceil(angle / bin_rad - 0.5f);
    return std::min(static_cast<std::uint32_t>(std::max(bin, 0.0f)), static_cast<std::uint32_t>(bins));
  }

  static bool clip(Stretch &stretch, float lowest_m) {
    const float low = stretch.low.at_m.y - lowest_m, high = stretch.high.at_m.y - lowest_m;
    if (low <= 0.0f && high <= 0.0f)
      return false;
    if (low < 0.0f || high < 0.0f) {
      StretchEnd &moved = low < 0.0f ? stretch.low : stretch.high;
      moved = between(stretch.low, stretch.high, low / (low - high));
      moved.at_m.y = lowest_m;
    }
    return true;
  }

  // How far along a stretch it is met in a direction.
  static float part_at(const Stretch &stretch, const glm::vec2 &direction) {
    const float from = cross(stretch.low.at_m, direction), to = cross(direction, stretch.high.at_m);
    return std::clamp(from / std::max(from + to, std::numeric_limits<float>::min()), 0.0f, 1.0f);
  }
  static glm::vec3 weights_at(const Stretch &stretch, const glm::vec2 &direction) {
    return between(stretch.low, stretch.high, part_at(stretch, direction)).weights;
  }

  const Stretch &stretch(std::int32_t number) const { return stretches_[static_cast<std::size_t>(number)]; }

  // Where what bin i - 1 sees gives way to what bin i sees: at an end of these between the bins' middles.
  // Ends of small ones are no borders: others that no bin sees may lie beside them, and bins are right on
  // average.
  float border(std::int32_t before, std::int32_t after, std::uint32_t i) const {
    const float low = (static_cast<float>(i) - 0.5f) * bin_rad, high = low + bin_rad;
    const auto is_border = [&](std::int32_t number, float angle) {
      constexpr float large = 3.0f * bin_rad;
      return stretch(number).high.angle - stretch(number).low.angle > large && angle >= low && angle <= high;
    };
    const bool ends = before != none && is_border(before, stretch(before).high.angle),
               begins = after != none && is_border(after, stretch(after).low.angle);
    if (ends && begins)
      return 0.5f * (stretch(before).high.angle + stretch(after).low.angle);
    if (ends)
      return stretch(before).high.angle;
    return begins ? stretch(after).low.angle : static_cast<float>(i) * bin_rad;
  }

  static SeenRun part_of(const Stretch &stretch, float from, float to) {
    const auto at = [&](float angle) {
      if (angle <= stretch.low.angle)
        return stretch.low;
      if (angle >= stretch.high.angle)
        return stretch.high;
      return between(stretch.low, stretch.high, part_at(stretch, {std::cos(angle), std::sin(angle)}));
    };
    const float covered = std::min(to, stretch.high.angle) - std::max(from, stretch.low.angle);
    return {at(from), at(to), covered > 0.0f ? (to - from) / covered : 0.0f};
  }

  std::vector<Stretch> stretches_;
  alignas(64) std::array<float, bins> nearness_;
  alignas(64) std::array<std::int32_t, bins + 1> nearest_; // a stretch of each bin, and no bin
};

} // namespace pmdsim
