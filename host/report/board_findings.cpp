#include "host/report/board_findings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numbers>

namespace pmdsim {
namespace {

constexpr double rounding_deg = 1e-6;

bool shines_behind(const Pattern &pattern) {
  return pattern.kind == Pattern::Kind::isotropic ||
         (pattern.kind == Pattern::Kind::diagram &&
          pattern.diagram->theta_rad.back() > std::numbers::pi / 2.0);
}

// Whether the diode is lit and has all that is seen behind it.
bool points_away(const Diode &diode, const Pose &world_from_illuminator,
                 const std::vector<glm::dvec3> &seen_m) {
  if (diode.intensity_w_sr == 0.0 || shines_behind(diode.pattern))
    return false;
  const glm::dvec3 axis = world_from_illuminator.direction(diode.axis),
                   place_m = world_from_illuminator.point(diode.position_m);
  return std::ranges::none_of(
      seen_m, [&](const glm::dvec3 &point_m) { return glm::dot(point_m - place_m, axis) > 0.0; });
}

double lean_deg(const glm::dvec3 &axis) {
  return glm::degrees(std::atan2(std::hypot(axis.x, axis.y), axis.z));
}

// "x -25 to 25 mm".
std::string span_text(const char *name, double min_m, double max_m) {
  // Sines and cosines of rings leave a rounding of zero.
  const auto mm = [](double length_m) { return std::abs(length_m) < 1e-12 ? 0.0 : 1e3 * length_m; };
  return mm(max_m) - mm(min_m) < 1e-9 ? fmt::format("{} {:.5g} mm", name, mm(min_m))
                                      : fmt::format("{} {:.5g} to {:.5g} mm", name, mm(min_m), mm(max_m));
}

// "numbers 1, 4 and 7", "numbers 1, 2, 3, 4, 5 and 3 more".
std::string numbers_text(const std::vector<std::size_t> &numbers) {
  constexpr std::size_t most = 5;
  if (numbers.size() == 1)
    return fmt::format("number {}", numbers.front());
  const std::vector<std::size_t> shown(
      numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(std::min(numbers.size(), most)));
  const std::string more = numbers.size() > most ? fmt::format(" and {} more", numbers.size() - most) : "";
  return fmt::format("numbers {}{}", fmt::join(shown, ", "), more);
}

} // namespace

BoardFindings board_findings(const Setup &setup, const Illuminator &illuminator,
                             const std::vector<glm::dvec3> &seen_m) {
  BoardFindings board{illuminator.diodes.front().position_m, illuminator.diodes.front().position_m};
  const bool is_told = !seen_m.empty() && !setup.bounces.any() && !setup.motion;
  for (std::size_t i = 0; i < illuminator.diodes.size(); ++i) {
    const Diode &diode = illuminator.diodes[i];
    board.min_m = glm::min(board.min_m, diode.position_m);
    board.max_m = glm::max(board.max_m, diode.position_m);
    board.largest_lean_deg = std::max(board.largest_lean_deg, lean_deg(diode.axis));
    if (is_told && points_away(diode, illuminator.world_from_illuminator, seen_m))
      board.turned_away.push_back(i);
  }
  return board;
}

std::string board_text(const BoardFindings &board) {
  const glm::dvec3 &min_m = board.min_m, &max_m = board.max_m;
  return fmt::format("{}, {}, {}, {}", span_text("x", min_m.x, max_m.x), span_text("y", min_m.y, max_m.y),
                     span_text("z", min_m.z, max_m.z),
                     board.largest_lean_deg < rounding_deg
                         ? "axes along +z"
                         : fmt::format("axes up to {:.4g}° from +z", board.largest_lean_deg));
}

std::optional<Warning> turned_away_warning(const Setup &setup, std::size_t number,
                                           const BoardFindings &board) {
  const Illuminator &illuminator = setup.start.illuminators.at(number);
  const std::size_t away = board.turned_away.size(), count = illuminator.diodes.size();
  if (away == 0 || away == count)
    return std::nullopt;
  const nlohmann::ordered_json &all = setup.as_used.at("illuminators");
  const auto found = std::ranges::find_if(
      all, [&](const nlohmann::ordered_json &each) { return each.at("name") == illuminator.name; });
  return Warning{warning_code("diodes-turned-away"),
                 fmt::format("{}: /illuminators/{}/diodes", setup.file.string(), found - all.begin()),
                 fmt::format("{} of {} diodes of {} {} away from all that is seen: {}, counted from 0: turn "
                             "{}, +z of an illuminator is forward",
                             away, count, illuminator.name, away == 1 ? "points" : "point",
                             numbers_text(board.turned_away), away == 1 ? "its axis" : "their axes")};
}

} // namespace pmdsim
