#include "host/input/setup/plausibility.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr double beside_m = 0.5; // a camera's light is so near to its lens
constexpr double least_way_m = 0.1;

double way_m(const Pose &from, const Pose &to) { return glm::distance(from.translation_m, to.translation_m); }

} // namespace

std::vector<Warning> light_left_behind(const Setup &setup, const Place &root) {
  if (!setup.motion || setup.frames.count < 2)
    return {};
  const Instant end = setup.at(setup.frames.time_s(setup.frames.count - 1));
  std::vector<Warning> warnings;
  for (std::size_t i = 0; i < setup.start.sensors.size(); ++i) {
    const Sensor &sensor = setup.start.sensors[i];
    const Pose &lens = sensor.world_from_camera;
    if (way_m(lens, end.sensors[i].world_from_camera) < least_way_m)
      continue;
    for (std::size_t k = 0; k < setup.start.illuminators.size(); ++k) {
      const Illuminator &light = setup.start.illuminators[k];
      if (way_m(light.world_from_illuminator, lens) > beside_m ||
          way_m(light.world_from_illuminator, end.illuminators[k].world_from_illuminator) > 0.0)
        continue;
      warnings.push_back(input_warning(
          warning_code("light-left-behind"), root / "illuminators" / k / "pose",
          fmt::format("sensor {} moves, and illuminator {}, which is beside it at first, stays where it is: "
                      "give the illuminator {{\"sensor\": \"{}\"}} as its pose, or move a node that has both",
                      sensor.name, light.name, sensor.name)));
    }
  }
  return warnings;
}

} // namespace pmdsim
