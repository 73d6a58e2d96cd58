#include "host/capture/other_cameras.h"

#include "engine/electronics/other_light.h"
#include "host/capture/progress.h"

#include <algorithm>
#include <chrono>

namespace pmdsim {
namespace {

std::vector<Illuminator> illuminators_at(double modulation_hz, const Instant &instant) {
  std::vector<Illuminator> illuminators;
  for (const OtherIlluminator &other : instant.others)
    if (other.modulation_hz == modulation_hz)
      illuminators.push_back(other.illuminator);
  return illuminators;
}

// Adds the pass to a frame's times when it dies.
class PassTimer {
public:
  explicit PassTimer(Measurement &frame) : frame_(frame) {}
  ~PassTimer() {
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    frame_.passes.push_back({"other_cameras", ms});
    frame_.frame_ms += ms;
  }
  PassTimer(const PassTimer &) = delete;
  PassTimer &operator=(const PassTimer &) = delete;

private:
  Measurement &frame_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace

OtherCameras::OtherCameras(const Setup &setup, const std::string &device, std::uint32_t paths)
    : setup_(setup) {
  const bool any_reached = std::ranges::any_of(
      setup.start.sensors, [](const Sensor &sensor) { return sensor.electronics.has_value(); });
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

void OtherCameras::add_to(const Sensor &sensor, double frame_s, Measurement &frame) {
  const PassTimer timer(frame);
  for (Other &other : cameras_)
    add_other_light(sensor, frame_s, {other.modulation_hz, seen_by(other)}, frame);
}

void OtherCameras::add_to(const Sensor &sensor, std::size_t frequency, std::size_t tap, double begin_s,
                          Measurement &exposure, std::vector<float> &correlation) {
  const PassTimer timer(exposure);
  for (Other &other : cameras_) {
    const OtherLight light{other.modulation_hz, seen_by(other)};
    add_beat(sensor, frequency, tap, begin_s, light, correlation);
    add_mean(light, exposure.mean_radiance);
  }
}

const Measurement &OtherCameras::seen_by(Other &other) const {
  if (!other.seen)
    other.seen = other.camera.measure_light([](double) { throw_if_interrupted(); });
  return *other.seen;
}

} // namespace pmdsim
