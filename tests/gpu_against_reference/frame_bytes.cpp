#include "tests/gpu_against_reference/frame_bytes.h"

#include "tests/support/random_scenes.h"

namespace pmdsim::test {

std::string bytes_of(const Measurement &measurement) {
  std::string bytes;
  const auto append = [&bytes](const auto &channel) {
    bytes.append(reinterpret_cast<const char *>(channel.data()), channel.size() * sizeof(channel[0]));
  };
  for (const auto *channel :
       {&measurement.returns[0].amplitude, &measurement.returns[0].phase_rad,
        &measurement.returns[0].distance_m, &measurement.range_m, &measurement.z_m, &measurement.coverage})
    append(*channel);
  for (const auto *ids : {&measurement.triangle_id, &measurement.object_id, &measurement.sample_triangle_id})
    append(*ids);
  return bytes;
}

void prepare_repeatability_frame(Simulator &simulator) {
  Random random(2007);
  Sensor sensor;
  sensor.resolution = {256, 192};
  sensor.pixel_pitch_m = glm::dvec2(4e-4);
  sensor.focal_length_m = 0.1;
  sensor.samples = 2;
  sensor.world_from_camera = random.pose(10.0);
  const Scene scene = random_triangles(random, 200, sensor.world_from_camera);
  simulator.prepare(scene, sensor, random_illuminator(random, 30, sensor.world_from_camera),
                    Backscatter::lambert);
}

} // namespace pmdsim::test
