#include "engine/shadow/boards.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace pmdsim {
namespace {

// How far a diode may lie from the plane of its board. Boards are built to a tenth of a millimetre, but files
// hold them as planes, off by no more than rounding.
constexpr double flatness_m = 1e-9;

// The plane normal . p = offset of some places.
struct FlatPlane {
  glm::dvec3 normal;
  double offset_m;

  bool holds(std::span<const glm::dvec3> places_m) const {
    return std::ranges::all_of(places_m, [this](const glm::dvec3 &place_m) {
      return std::abs(glm::dot(normal, place_m) - offset_m) <= flatness_m;
    });
  }
};

// Across the view where the places allow it: of one place, and of several in a line, too.
std::optional<FlatPlane> plane_of(std::span<const glm::dvec3> places_m) {
  const glm::dvec3 view(0.0, 0.0, 1.0), &first_m = places_m.front();
  if (const FlatPlane across{view, first_m.z}; across.holds(places_m))
    return across;
  const auto distance = [&](const glm::dvec3 &place_m) { return glm::distance(place_m, first_m); };
  const glm::dvec3 along = glm::normalize(*std::ranges::max_element(places_m, {}, distance) - first_m);
  const auto beside = [&](const glm::dvec3 &place_m) {
    return glm::length(glm::cross(along, place_m - first_m));
  };
  const glm::dvec3 &farthest_m = *std::ranges::max_element(places_m, {}, beside);
  glm::dvec3 normal = glm::cross(along, farthest_m - first_m);
  if (beside(farthest_m) <= flatness_m)
    normal = view - glm::dot(view, along) * along;
  if (!(glm::length(normal) > 0.0))
    return std::nullopt;
  normal = glm::normalize(normal);
  const FlatPlane plane{normal, glm::dot(normal, first_m)};
  return plane.holds(places_m) ? std::optional(plane) : std::nullopt;
}

// Its z axis points away from the scene, which the lens looks at along +z.
Board board_on(const FlatPlane &plane) {
  const glm::dvec3 z = plane.normal.z > 0.0 ? -plane.normal : plane.normal;
  const glm::dvec3 aside = std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(aside - glm::dot(aside, z) * z), y = glm::cross(z, x);
  Board board;
  board.rotation = glm::transpose(glm::dmat3(x, y, z));
  const double height_m = glm::dot(z, plane.normal) * plane.offset_m;
  board.translation_m = {0.0, 0.0, -height_m};
  board.lens_z_m = -height_m;
  board.is_flat = true;
  return board;
}

Board board_of_space() {
  Board board;
  board.rotation = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
  return board;
}

void add_support(Board &board, const glm::dvec3 &place_m) {
  constexpr double diagonal = 0.70710678118654752;
  const double u = diagonal * (place_m.x + place_m.y), v = diagonal * (place_m.x - place_m.y);
  const std::array along{place_m.x, -place_m.x, place_m.y, -place_m.y, u, -u, v, -v};
  for (std::size_t i = 0; i < along.size(); ++i)
    board.supports_m[i] = std::max(board.supports_m[i], along[i]);
}

void add_to(Board &board, std::size_t window, std::span<const glm::dvec3> places_m) {
  board.windows.push_back(window);
  for (const glm::dvec3 &place_m : places_m) {
    const glm::dvec3 place = board.in_frame(place_m);
    add_support(board, place);
    board.radius_m = std::max(board.radius_m, std::hypot(place.x, place.y));
    if (board.is_flat)
      continue;
    board.lowest_m = std::min(board.lowest_m, place.z);
    board.highest_m = std::max(board.highest_m, place.z);
  }
}

} // namespace

std::vector<WindowPart> parts_of(const SourceWindow &window, const SourceGroups &groups) {
  const std::uint32_t of_run = bundles_per_run(groups);
  const auto of_runs = [&](std::uint32_t first, std::uint32_t last) {
    return SourceWindow{first, last, (last - first) * of_run};
  };
  const auto is_flat = [&](const SourceWindow &runs) {
    return plane_of(places_of(runs, groups)).has_value();
  };
  std::vector<WindowPart> parts;
  bool last_is_flat = false;
  for (std::uint32_t run = window.first_run; run < window.last_run; ++run) {
    const SourceWindow alone = of_runs(run, run + 1);
    const bool is_flat_alone = is_flat(alone);
    if (!parts.empty() && last_is_flat == is_flat_alone) {
      const SourceWindow joined = of_runs(parts.back().runs.first_run, run + 1);
      if (joined.bundles <= shader::bundles_per_window && is_flat(joined) == is_flat_alone) {
        parts.back().runs = joined;
        continue;
      }
    }
    parts.push_back({alone, (run - window.first_run) * of_run});
    last_is_flat = is_flat_alone;
  }
  return parts;
}

std::vector<Board> find_boards(const SourceGroups &groups, const std::vector<SourceWindow> &windows) {
  std::vector<Board> boards;
  std::vector<std::optional<FlatPlane>> planes; // beside them
  for (std::size_t window = 0; window < windows.size(); ++window) {
    const std::vector<glm::dvec3> places_m = places_of(windows[window], groups);
    const auto plane = plane_of(places_m);
    const auto known = std::ranges::find_if(planes, [&](const std::optional<FlatPlane> &other) {
      return plane ? other && other->holds(places_m) : !other;
    });
    const std::size_t at = static_cast<std::size_t>(known - planes.begin());
    if (known == planes.end()) {
      boards.push_back(plane ? board_on(*plane) : board_of_space());
      planes.push_back(plane);
    }
    add_to(boards[at], window, places_m);
  }
  return boards;
}

std::vector<glm::dvec3> places_of(const SourceWindow &window, const SourceGroups &groups) {
  std::vector<glm::dvec3> places_m;
  for (std::uint32_t bundle = 0; bundle < window.bundles; ++bundle) {
    const auto positions = positions_of(window, bundle, groups);
    for (std::size_t i = 0; i < shader::diodes_per_bundle; ++i)
      places_m.push_back(positions[std::min(i, positions.size() - 1)].position_m);
  }
  return places_m;
}

} // namespace pmdsim
