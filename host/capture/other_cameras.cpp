#include "host/capture/other_cameras.h"

#include "engine/model/stopwatch.h"
#include "host/capture/progress.h"

#include <algorithm>

namespace pmdsim {
namespace {

std::vector<Illuminator> illuminators_at(double modulation_hz, const Instant &instant) {
  std::vector<Illuminator> illuminators;
  for (const OtherIlluminator &other : instant.others)
    if (other.modulation_hz == modulation_hz)
      illuminators.push_back(other.illuminator);
  return illuminators;
}

} // namespace

OtherCameras::OtherCameras(const Setup &setup, const std::string &device, std::uint32_t paths,
                           bool are_asked_for)
    : setup_(setup) {
  const bool any_reached =
      are_asked_for && std::ranges::any_of(setup.start.sensors, [](const Sensor &sensor) {
        return sensor.electronics.has_value();
      });
  for (const OtherIlluminator &other : setup.start.others)
    if (any_reached &&
        std::ranges::find(cameras_, other.modulation_hz, &Other::modulation_hz) == cameras_.end())
      cameras_.push_back({other.modulation_hz, Camera(device, {.paths = paths})});
}

void OtherCameras::prepare(const Instant &instant, const Sensor &sensor) {
  for (Other &other : cameras_) {
    Sensor seeing = sensor;
    seeing.modulation_hz = {other.modulation_hz};
    seeing.waveform = {};
    other.seen.reset();
    other.camera.prepare(instant.scene, seeing, illuminators_at(other.modulation_hz, instant),
                         setup_.backscatter, setup_.shadows, {}, setup_.bounces);
  }
}

void OtherCameras::add_to(const Sensor &sensor, double frame_s, const Progress &progress,
                          Measurement &frame) {
  Stopwatch stopwatch;
  for (Other &other : cameras_)
    add_other_light(sensor, frame_s, seen_by(other, progress), frame);
  stopwatch.add_to(frame, "other_cameras");
}

void OtherCameras::add_to(const Sensor &sensor, std::size_t frequency, std::size_t tap, double begin_s,
                          const Progress &progress, Measurement &exposure, std::vector<float> &correlation) {
  Stopwatch stopwatch;
  for (Other &other : cameras_) {
    add_beat(sensor, frequency, tap, begin_s, seen_by(other, progress), correlation);
    add_mean(seen_by(other, progress), exposure.mean_radiance);
  }
  stopwatch.add_to(exposure, "other_cameras");
}

void OtherCameras::give_up_devices() {
  for (Other &other : cameras_)
    other.camera.give_up_device();
}

const OtherLight &OtherCameras::seen_by(Other &other, const Progress &progress) {
  if (!other.seen)
    other.seen =
        other_light_of(other.modulation_hz, other.camera.measure_light([&](double) { progress(1.0); }));
  return *other.seen;
}

} // namespace pmdsim
