#pragma once
// Light that bounces, for a simulator: solved once for a scene and its light, and added to each frame.

#include "engine/model/bounces.h"
#include "engine/model/illuminator.h"
#include "engine/model/measurement.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <functional>
#include <memory>
#include <vector>

namespace pmdsim {

struct BouncesRequest {
  const Scene &scene;
  const Sensor &sensor;
  const std::vector<Illuminator> &illuminators;
  Shadows shadows;
  Bounces bounces;
};

class Multipath {
public:
  Multipath();
  ~Multipath();

  // What was solved is kept where scene, light and bounces are what they were, whatever the sensor.
  void prepare(const BouncesRequest &request);
  // Adds what bounced to a frame, which has the ids of its samples where a pixel has several, with its report
  // and the time that it took. `progress` as Simulator::measure's. Throws Error: input (diverges),
  // out_of_memory, accuracy (the error asked for is not reached).
  void add_to(Measurement &measurement, const std::function<void(double)> &progress);

  // Looks along some lines to learn how long they take. Throws Error: out_of_memory.
  static BouncesForecast forecast(const Scene &scene, const Sensor &sensor, const Bounces &bounces);

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pmdsim
