#include "host/report/coarser_sensor.h"

namespace pmdsim {

Sensor coarser(Sensor sensor, double factor) {
  if (factor <= 1.0)
    return sensor;
  const glm::uvec2 fewest = glm::min(sensor.resolution, glm::uvec2(8));
  const glm::uvec2 resolution = glm::max(glm::uvec2(glm::dvec2(sensor.resolution) / factor), fewest);
  sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / glm::dvec2(resolution);
  sensor.resolution = resolution;
  return sensor;
}

} // namespace pmdsim
