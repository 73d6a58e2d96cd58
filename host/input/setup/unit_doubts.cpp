#include "host/input/setup/parts.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/glm.hpp>

namespace pmdsim {
namespace {

// Beyond these a value is likelier to be in another unit than to be meant.
constexpr double least_usual_hz = 1e4; // an ambiguity range of 15 km
constexpr double largest_usual_focal_length_m = 1.0;
constexpr double largest_usual_pitch_m = 1e-2;

Warning doubt(const Place &place, const std::string &text) {
  return input_warning(warning_code("unusual-value"), place, text);
}

constexpr double largest_usual_board_m = 2.0; // from an illuminator's origin to a diode

} // namespace

std::vector<Warning> unit_doubts(const Sensor &sensor, const Place &place) {
  std::vector<Warning> doubts;
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
    if (const double hz = sensor.modulation_hz[i]; hz < least_usual_hz)
      doubts.push_back(doubt(place / "modulation_hz" / i,
                             fmt::format("{} Hz is unusually low; 20 MHz are written 20e6", hz)));
  if (sensor.focal_length_m > largest_usual_focal_length_m)
    doubts.push_back(
        doubt(place / "focal_length_m",
              fmt::format("{} m is unusually long; 12 mm are written 12e-3", sensor.focal_length_m)));
  for (const int axis : {0, 1})
    if (sensor.pixel_pitch_m[axis] > largest_usual_pitch_m)
      doubts.push_back(
          doubt(place / "pixel_pitch_m" / static_cast<std::size_t>(axis),
                fmt::format("{} m is unusually wide; 45 um are written 45e-6", sensor.pixel_pitch_m[axis])));
  return doubts;
}

std::vector<Warning> unit_doubts(const std::vector<Diode> &diodes, const Place &place) {
  double farthest_m = 0.0;
  std::size_t far = 0;
  for (const Diode &diode : diodes) {
    const double distance_m = glm::length(diode.position_m);
    farthest_m = std::max(farthest_m, distance_m);
    far += distance_m > largest_usual_board_m ? 1u : 0u;
  }
  if (far == 0)
    return {};
  return {doubt(place,
                fmt::format("{} of {} diodes lie far away, up to {:.4g} m from the illuminator's origin: are "
                            "these millimetres? {:.4g} mm are written {:.4g}",
                            far, diodes.size(), farthest_m, farthest_m, 1e-3 * farthest_m))};
}

} // namespace pmdsim
