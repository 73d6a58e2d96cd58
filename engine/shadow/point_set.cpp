#include "engine/shadow/point_set.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace pmdsim {
namespace {

constexpr std::size_t places_of_leaf = 8;
// Boxes that are looked at, for each place that there is.
constexpr std::size_t looks_a_place = 300;
constexpr std::size_t looks_at_least = 1'000'000;

double height_m(const Plane &plane, const glm::dvec3 &place_m) {
  return glm::dot(plane.normal, place_m) - plane.offset_m;
}

} // namespace

PlaceSet::PlaceSet(std::vector<glm::dvec3> places_m)
    : places_m_(std::move(places_m)), looks_left_(looks_at_least + looks_a_place * places_m_.size()) {
  for (const glm::dvec3 &place_m : places_m_)
    size_m_ = std::max(size_m_, std::abs(place_m.x) + std::abs(place_m.y) + std::abs(place_m.z));
  if (!places_m_.empty())
    add_node(0, places_m_.size());
}

// Halved along the longest side of their box, again and again.
void PlaceSet::add_node(std::size_t first, std::size_t count) {
  const auto places = std::span(places_m_).subspan(first, count);
  Node node{places.front(), places.front(), first, count, 0};
  for (const glm::dvec3 &place_m : places) {
    node.low_m = glm::min(node.low_m, place_m);
    node.high_m = glm::max(node.high_m, place_m);
  }
  const std::size_t at = nodes_.size();
  nodes_.push_back(node);
  if (count <= places_of_leaf)
    return;
  const glm::dvec3 spread = node.high_m - node.low_m;
  const glm::length_t axis =
      spread.x >= spread.y ? (spread.x >= spread.z ? 0 : 2) : (spread.y >= spread.z ? 1 : 2);
  const std::size_t half = count / 2;
  std::ranges::nth_element(places, places.begin() + static_cast<std::ptrdiff_t>(half), {},
                           [axis](const glm::dvec3 &place_m) { return place_m[axis]; });
  add_node(first, half);
  nodes_[at].second_child = nodes_.size();
  add_node(first + half, count - half);
}

bool PlaceSet::any_above(const Plane &plane, double margin_m) {
  return !nodes_.empty() && any_above(0, plane, margin_m);
}

bool PlaceSet::any_above(std::size_t at, const Plane &plane, double margin_m) {
  const Node &node = nodes_[at];
  const glm::bvec3 up = glm::greaterThan(plane.normal, glm::dvec3(0.0));
  if (height_m(plane, glm::mix(node.low_m, node.high_m, up)) <= margin_m)
    return false;
  if (looks_left_ == 0)
    return true;
  --looks_left_;
  if (node.second_child != 0)
    return any_above(at + 1, plane, margin_m) || any_above(node.second_child, plane, margin_m);
  return std::ranges::any_of(std::span(places_m_).subspan(node.first, node.count),
                             [&](const glm::dvec3 &place_m) { return height_m(plane, place_m) > margin_m; });
}

} // namespace pmdsim
