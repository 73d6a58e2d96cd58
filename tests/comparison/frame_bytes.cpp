#include "tests/comparison/frame_bytes.h"

#include "engine/model/channels.h"
#include "tests/support/random_scenes.h"

#include <functional>
#include <stdexcept>

namespace pmdsim::test {

namespace {

template <typename Channel>
void append(std::string &bytes, const Channel &channel) {
  bytes.append(reinterpret_cast<const char *>(channel.data()), channel.size() * sizeof(channel[0]));
}

void fill_in_part(Sensor &sensor) {
  sensor.fill_factor = {0.6, 0.4};
  sensor.samples = 3;
}

void make_square(Sensor &sensor) {
  sensor.waveform.kind = Waveform::Kind::square;
  sensor.taps = 5;
  sensor.modulation_hz = {20e6, 60e6};
}

struct Change {
  std::string name;
  std::function<void(Sensor &)> of;
  Shadows shadows = Shadows::off;
  Mode mode = Mode::exact;
  std::size_t diodes = 30;
};

const std::vector<Change> &changes() {
  static const std::vector<Change> all{
      {"pinhole", [](Sensor &) {}},
      {"brown",
       [](Sensor &s) {
         s.distortion = BrownConrady{-0.2, 0.05, 0.01, -0.02, 0.01};
       }},
      {"fisheye",
       [](Sensor &s) {
         s.distortion = Fisheye{-0.03, 0.01, -0.004, 0.0005};
       }},
      {"tilted_filled",
       [](Sensor &s) {
         s.chip.rotation_rad = {0.1, -0.05, 0.2};
         fill_in_part(s);
       }},
      {"tilted",
       [](Sensor &s) {
         s.chip.rotation_rad = {0.1, -0.05, 0.2};
       }},
      {"one_sample_filled",
       [](Sensor &s) {
         fill_in_part(s);
         s.samples = 1;
         s.modulation_hz = {20e6, 60e6};
       }},
      // Images of records have no gaps between such rows, those of tags have.
      {"records_without_gaps",
       [](Sensor &s) {
         s.samples = 1;
         s.resolution.x = 252;
       }},
      {"tags_with_gaps",
       [](Sensor &s) {
         s.samples = 1;
         s.resolution.x = 252;
       },
       Shadows::off, Mode::automatic},
      {"records_with_gaps",
       [](Sensor &s) {
         s.samples = 1;
         s.resolution = {253, 191};
       }},
      {"several_runs", [](Sensor &) {}, Shadows::off, Mode::exact, 700},
      {"square", make_square},
      {"fisheye_filled_square",
       [](Sensor &s) {
         s.distortion = Fisheye{};
         fill_in_part(s);
         make_square(s);
       }},
      {"shadows", [](Sensor &) {}, Shadows::automatic},
      {"shadows_brown_tilted_filled_square",
       [](Sensor &s) {
         s.distortion = BrownConrady{-0.2, 0.05, 0.01, -0.02, 0.01};
         s.chip.rotation_rad = {0.1, -0.05, 0.2};
         fill_in_part(s);
         make_square(s);
       },
       Shadows::automatic},
      {"automatic", [](Sensor &) {}, Shadows::off, Mode::automatic},
      {"automatic_one_sample", [](Sensor &s) { s.samples = 1; }, Shadows::off, Mode::automatic},
      {"automatic_brown",
       [](Sensor &s) {
         s.distortion = BrownConrady{-0.2, 0.05, 0.01, -0.02, 0.01};
       },
       Shadows::off, Mode::automatic},
      {"automatic_shadows_tilted_filled",
       [](Sensor &s) {
         s.chip.rotation_rad = {0.1, -0.05, 0.2};
         fill_in_part(s);
       },
       Shadows::automatic, Mode::automatic},
  };
  return all;
}

} // namespace

std::string bytes_of(const Measurement &measurement) {
  std::string bytes;
  for (const Return &of_frequency : measurement.returns) {
    for (const auto *channel : {&of_frequency.amplitude, &of_frequency.phase_rad, &of_frequency.distance_m})
      append(bytes, *channel);
    for (const auto &tap : of_frequency.taps)
      append(bytes, tap);
  }
  for (const auto *channel :
       {&measurement.range_m, &measurement.z_m, &measurement.coverage, &measurement.lit})
    append(bytes, *channel);
  for (const auto *ids : {&measurement.triangle_id, &measurement.object_id, &measurement.sample_triangle_id,
                          &measurement.sample_pixel_id, &measurement.sample_visibility})
    append(bytes, *ids);
  for_each_channel(measurement, [&](const ChannelIndex &of, const auto &values) {
    if (of.row.slot.area == DeviceSlot::Area::mean || of.row.slot.area == DeviceSlot::Area::electrons)
      append(bytes, values);
  });
  return bytes;
}

const std::vector<std::string> &repeatability_frames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const Change &change : changes())
      result.push_back(change.name);
    return result;
  }();
  return names;
}

RepeatabilityFrame repeatability_frame(const std::string &name) {
  Random random(2007);
  Sensor sensor;
  sensor.resolution = {256, 192};
  sensor.pixel_pitch_m = glm::dvec2(4e-4);
  sensor.focal_length_m = 0.1;
  sensor.samples = 2;
  sensor.world_from_camera = random.pose(10.0);
  const Scene scene = random_triangles(random, 200, sensor.world_from_camera);
  for (const Change &change : changes())
    if (change.name == name) {
      change.of(sensor);
      Accuracy accuracy;
      accuracy.mode = change.mode;
      return {scene, sensor, random_illuminator(random, change.diodes, sensor.world_from_camera),
              change.shadows, accuracy};
    }
  throw std::out_of_range("no repeatability frame " + name);
}

SimulatorOptions keep_everything(std::uint32_t max_strip_samples) {
  return {.device = {},
          .max_strip_samples = max_strip_samples,
          .keep_sample_ids = true,
          .keep_visibility = true,
          .keep_taps = true};
}

Measurement measure(Simulator &simulator, const RepeatabilityFrame &frame) {
  simulator.prepare(frame.scene, frame.sensor, {frame.illuminator}, Backscatter::lambert, frame.shadows,
                    frame.accuracy);
  return simulator.measure();
}

} // namespace pmdsim::test
