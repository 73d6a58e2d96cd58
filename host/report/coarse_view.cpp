#include "host/report/coarse_view.h"

#include "engine/lens/lens.h"
#include "engine/reference/reference.h"
#include "host/report/findings.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

constexpr double view_columns = 64.0; // rays, along the frame's longer side

} // namespace

CoarseView coarse_view(const Setup &setup, const Sensor &fine) {
  Sensor sensor = coarser(fine, std::max(fine.resolution.x, fine.resolution.y) / view_columns);
  sensor.samples = 1;
  sensor.modulation_hz.resize(1); // geometry is all that is asked for
  sensor.waveform = {};
  sensor.electronics.reset();
  const std::vector<double> ranges_m =
      reference::simulate(setup.start.scene, sensor, {monostatic_illuminator(sensor.world_from_camera)},
                          setup.backscatter)
          .range_m;
  const Lens lens(sensor);
  CoarseView view;
  for (std::size_t pixel = 0; pixel < ranges_m.size(); ++pixel) {
    if (std::isnan(ranges_m[pixel]))
      continue;
    view.ranges_m.push_back(ranges_m[pixel]);
    const glm::uvec2 place(pixel % sensor.resolution.x, pixel / sensor.resolution.x);
    if (const auto ray = lens.ray(lens.on_chip_m(glm::dvec2(place) + 0.5)))
      view.points_m.push_back(sensor.world_from_camera.point(ranges_m[pixel] * *ray));
  }
  return view;
}

} // namespace pmdsim
