#pragma once
// Light of other cameras in the scene, as a setup's illuminators with modulation_hz give it, in frames of a
// sensor with electronics.

#include "engine/electronics/other_light.h"
#include "host/capture/camera.h"

#include <cstdint>
#include <list>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

class OtherCameras {
public:
  // Of a setup, which must outlive it; `device` and `paths` as Camera's and Extras'. None where nobody asks
  // for their light.
  OtherCameras(const Setup &setup, const std::string &device, std::uint32_t paths, bool are_asked_for = true);

  // Whether frames of the sensor have light of theirs.
  bool reach(const Sensor &sensor) const { return sensor.electronics && !cameras_.empty(); }

  // What is added from here on is what the sensor sees of them at this instant, which must outlive it.
  void prepare(const Instant &instant, const Sensor &sensor);
  // As add_other_light(), of all of them. `progress` may throw meanwhile. Adds the pass "other_cameras" to
  // the frame's times. Throws Error, interrupted among others.
  void add_to(const Sensor &sensor, double frame_s, const Progress &progress, Measurement &frame);
  // The same of the exposure of one tap, whose correlation samples are apart.
  void add_to(const Sensor &sensor, std::size_t frequency, std::size_t tap, double begin_s,
              const Progress &progress, Measurement &exposure, std::vector<float> &correlation);

  // Each has a device of its own, and where one is lost the others most likely are.
  void give_up_devices();

private:
  // One for each frequency: a camera whose sensor sees nothing but its light, and what it has seen since it
  // was prepared.
  struct Other {
    double modulation_hz;
    Camera camera;
    std::optional<OtherLight> seen{};
  };

  static const OtherLight &seen_by(Other &other, const Progress &progress);

  const Setup &setup_;
  std::list<Other> cameras_;
};

} // namespace pmdsim
