#include "engine/reduction/directional_bounds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>

namespace pmdsim {
namespace {

constexpr double largest_size_over_distance = 0.25;
constexpr std::size_t pieces_at_most = 4096;
constexpr double sights_per_octave = 2.0;

void cut(const VisibleBox &box, const VisibleBox &around, int cuts_left, std::vector<VisibleBox> &pieces) {
  if (cuts_left == 0 ||
      glm::distance(box.low_m, box.high_m) <= largest_size_over_distance * least_distance_m(box, around)) {
    pieces.push_back(box);
    return;
  }
  const int axis = box.longest_side();
  VisibleBox low = box, high = box;
  low.high_m[axis] = high.low_m[axis] = 0.5 * (box.low_m[axis] + box.high_m[axis]);
  cut(low, around, cuts_left - 1, pieces);
  cut(high, around, cuts_left - 1, pieces);
}

// Where a box's points lie along a direction: the middle and how far to either side.
struct Along {
  double middle_m, half_m;
};

Along along(const glm::dvec3 &direction, const glm::dvec3 &centre_m, const glm::dvec3 &half_m) {
  return {glm::dot(direction, centre_m), glm::dot(glm::abs(direction), half_m)};
}

DirectionalBounds sight_of(const VisibleBox &box, const glm::dvec3 &place_m, const glm::dmat3 &axes,
                           const glm::dvec3 &beam) {
  const glm::dvec3 centre_m = 0.5 * (box.low_m + box.high_m) - place_m;
  const glm::dvec3 half_m = 0.5 * (box.high_m - box.low_m);
  const double range_m = glm::distance(place_m, glm::clamp(place_m, box.low_m, box.high_m));
  DirectionalBounds direction{range_m, glm::dvec3(-1.0), glm::dvec3(1.0), -1.0};
  const double largest_range_m = glm::length(glm::abs(centre_m) + half_m);
  const auto over_range = [&](double at_m, bool rounded_up) {
    return at_m / ((at_m > 0.0) == rounded_up ? range_m : largest_range_m);
  };
  if (!(range_m > 0.0))
    return direction;
  for (int i = 0; i < 3; ++i) {
    const auto [middle_m, side_m] = along(axes[i], centre_m, half_m);
    direction.least[i] = std::max(-1.0, over_range(middle_m - side_m, false));
    direction.largest[i] = std::min(1.0, over_range(middle_m + side_m, true));
  }
  const auto [middle_m, side_m] = along(beam, centre_m, half_m);
  direction.beam_cosine = over_range(middle_m - side_m, false);
  return direction;
}

void widen(DirectionalBounds &direction, const DirectionalBounds &other) {
  direction.range_m = std::min(direction.range_m, other.range_m);
  direction.least = glm::min(direction.least, other.least);
  direction.largest = glm::max(direction.largest, other.largest);
  direction.beam_cosine = std::min(direction.beam_cosine, other.beam_cosine);
}

} // namespace

double least_distance_m(const VisibleBox &a, const VisibleBox &b) {
  return glm::length(glm::max(glm::dvec3(0.0), glm::max(a.low_m - b.high_m, b.low_m - a.high_m)));
}

double largest_distance_m(const VisibleBox &a, const VisibleBox &b) {
  return glm::length(glm::max(glm::abs(a.high_m - b.low_m), glm::abs(b.high_m - a.low_m)));
}

std::vector<VisibleBox> pieces_of(const std::vector<VisibleBox> &visible, const VisibleBox &around) {
  int cuts = 0;
  while (visible.size() << (cuts + 1) <= pieces_at_most)
    ++cuts;
  std::vector<VisibleBox> pieces;
  for (const VisibleBox &box : visible)
    cut(box, around, cuts, pieces);
  return pieces;
}

std::vector<DirectionalBounds> directional_bounds(const std::vector<VisibleBox> &pieces,
                                                  const glm::dvec3 &place_m, const glm::dmat3 &axes,
                                                  const glm::dvec3 &beam) {
  std::map<double, DirectionalBounds> by_range;
  for (const VisibleBox &piece : pieces) {
    const DirectionalBounds direction = sight_of(piece, place_m, axes, beam);
    const auto [found, is_new] =
        by_range.try_emplace(std::floor(sights_per_octave * std::log2(direction.range_m)), direction);
    if (!is_new)
      widen(found->second, direction);
  }
  const auto directions = by_range | std::views::values;
  return {directions.begin(), directions.end()};
}

} // namespace pmdsim
