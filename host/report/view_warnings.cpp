#include "host/report/view_warnings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace pmdsim {
namespace {

// Where the middle of the scene's bounding box lies, as seen by the sensor; empty where it moves, as the
// scene that is known is that of the start.
std::string centre_text(const Setup &setup, const Sensor &sensor) {
  const std::vector<glm::dvec3> &vertices_m = setup.start.scene.positions_m;
  if (vertices_m.empty() || setup.motion)
    return "";
  glm::dvec3 min_m = vertices_m.front(), max_m = min_m;
  for (const glm::dvec3 &vertex_m : vertices_m) {
    min_m = glm::min(min_m, vertex_m);
    max_m = glm::max(max_m, vertex_m);
  }
  const glm::dvec3 to_centre_m = 0.5 * (min_m + max_m) - sensor.world_from_camera.translation_m;
  const glm::dvec3 axis = sensor.world_from_camera.direction({0.0, 0.0, 1.0});
  const double off_deg =
      glm::degrees(std::atan2(glm::length(glm::cross(axis, to_centre_m)), glm::dot(axis, to_centre_m)));
  return fmt::format(": its centre lies {:.3g} degrees off the optical axis and {:.4g} m away", off_deg,
                     glm::length(to_centre_m));
}

} // namespace

Warning nothing_in_view(const Setup &setup, const Sensor &sensor, const std::string &place) {
  return {warning_code("nothing-in-view"), place,
          fmt::format(
              "nothing of the scene is in view{}; turn or move the sensor by its pose, or give the scene's "
              "materials doubleSided, where the lens is behind them",
              centre_text(setup, sensor))};
}

Warning beyond_ambiguity(const Setup &setup, const BeyondAmbiguity &beyond, const std::string &place) {
  constexpr double many_times = 3.0; // so much farther than the ambiguity range another unit is likelier
  constexpr double near_m = 10.0;    // where high frequencies wrap many times on purpose
  const bool is_other_unit = beyond.min_m > std::max(many_times * beyond.ambiguity_m, near_m) &&
                             !has_warned_of(setup, "scene-in-millimetres");
  return {warning_code("beyond-ambiguity"), place,
          fmt::format("what is visible lies {:.6g} m to {:.6g} m away, {:.3g} % of it beyond the ambiguity "
                      "range of {:.6g} m: distances wrap; {}a lower modulation_hz, or several of them with "
                      "unwrap_range_m, reach farther",
                      beyond.min_m, beyond.max_m, 100.0 * beyond.share, beyond.ambiguity_m,
                      is_other_unit
                          ? "are the scene's lengths centimetres or millimetres? glTF's are metres: put "
                            "all root nodes below one node of scale 0.01 or 0.001; else "
                          : "")};
}

bool has_warned_of(const Setup &setup, std::string_view code) {
  return std::ranges::find(setup.warnings, code, &Warning::code) != setup.warnings.end();
}

} // namespace pmdsim
