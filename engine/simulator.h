#pragma once
// The simulator: runs the passes of one frame on a Vulkan device, in order, and reads the measurement back.

#include "engine/model/accuracy.h"
#include "engine/model/bounces.h"
#include "engine/model/device_info.h"
#include "engine/model/illuminator.h"
#include "engine/model/measurement.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"
#include "engine/model/simulator_options.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pmdsim {

// Called with the fraction of the frame that is done, 0 to 1; may throw to stop the frame.
using Progress = std::function<void(double fraction)>;

// What the bounces of a frame will take; needs no device. Throws Error: out_of_memory.
BouncesForecast forecast_bounces(const Scene &scene, const Sensor &sensor, const Bounces &bounces);

class Simulator {
public:
  // Throws Error: no_device where no usable device matches.
  explicit Simulator(const SimulatorOptions &options);
  ~Simulator();
  Simulator(Simulator &&) noexcept;
  Simulator &operator=(Simulator &&) noexcept;

  const DeviceInfo &device() const;

  // As the constructor or change() was told.
  const SimulatorOptions &options() const;
  // Frames from the next prepare() on are measured so. The device and validation stay as they are.
  void change(const SimulatorOptions &options);
  // The device counts as lost, as where others of the process are: the next prepare() sets it up anew.
  void give_up_device();

  // With Mode::automatic `scene` must outlive the frames, which may have to be prepared anew, more exact.
  // Uploads what a frame needs and compiles its shaders. A device that was lost is set up anew first. Throws
  // Error: out_of_memory, device_lost, accuracy (the error asked for cannot be promised), input (diodes of
  // intensities more than 1e25 apart). With bounces surfaces have to be Backscatter::lambert, and `scene` has
  // to outlive the frames.
  void prepare(const Scene &scene, const Sensor &sensor, const std::vector<Illuminator> &illuminators,
               Backscatter backscatter, Shadows shadows = Shadows::off, const Accuracy &accuracy = {},
               const Bounces &bounces = {});
  // How the frame that was prepared is summed: names and values, for people and for JSON. It may change where
  // a frame has to be made again more exactly.
  std::vector<std::pair<std::string, std::string>> path() const;
  // One frame of what was prepared; the same bits at every call, but for the noise of
  // SimulatorOptions::count_electrons, which the number decides. Throws Error: out_of_memory, device_lost,
  // accuracy (the error asked for was not kept), input (more light returns than a float holds; light that
  // bounces without end).
  Measurement measure(const Progress &progress = {}, const ExposureNumber &number = {});
  // Takes the memory of a frame that is done with, for a later one; from any thread. (A large frame's memory
  // takes longer to come from the operating system than its values.)
  void reuse(Measurement &&frame);

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pmdsim
