#pragma once
// Whatever computes frames: a Vulkan device or the reference on the CPU, behind one face.

#include "engine/reference/reference.h"
#include "engine/simulator.h"
#include "host/input/setup/setup.h"
#include "host/report/memory_forecast.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// Extras that a measurement shall have beside its other channels.
struct Extras {
  bool sample_triangles = false;   // Measurement::sample_triangle_id, not from the reference
  bool reached = false;            // Measurement::sample_visibility, not from the reference
  bool taps = false;               // Return::taps, and those in electrons
  bool unrounded = false;          // Return::unrounded_distance_m and the like
  bool electrons_at_once = false;  // SimulatorOptions::count_electrons: nothing is added to the frames' light
  bool electrons_of_polar = false; // then of amplitude and phase, as beside noiseless channels: the same bits
  bool diodes_in_a_loop = false;   // nothing is summed beforehand, and the sum is a pass of its own
  // Where light bounces, the paths that the reference follows for each pixel; 0: as many as it chooses.
  std::uint32_t paths = 0;
};

// What a frame of the sensor, which is one of the setup's, takes beside the setup. `written_bytes`: of what
// is written of it, as bytes_of_largest_frame() counts. `max_strip_samples` as SimulatorOptions.
MemoryForecast forecast_of(const Setup &setup, const Sensor &sensor, const Extras &extras, MeasuredBy by,
                           std::size_t written_bytes, std::uint32_t max_strip_samples = 0);

// Of a device's strips where memory is short.
inline constexpr std::uint32_t short_strip_samples = 1u << 16;

// Whether a device's name, in any case, is the one of the reference.
bool names_the_reference(const std::string &device);

class Camera {
public:
  // `device` as SimulatorOptions::device, or "reference" in any case. Throws Error (no_device).
  // PMDSIM_VALIDATE in the environment, 1 or gpu, sets SimulatorOptions::validation.
  explicit Camera(const std::string &device, const Extras &extras = {});

  // Frames from the next prepare() on have these beside their other channels.
  void give(const Extras &extras);

  const std::string &wanted() const { return wanted_; } // as the constructor was told
  const Extras &extras() const { return extras_; }
  const std::string &device() const { return device_; }
  const std::string &driver() const { return driver_; }
  bool is_reference() const { return !simulator_; }
  MeasuredBy measured_by() const;
  // What a frame takes beyond what frames so far were granted of memory, and hold on to.
  std::uint64_t further_bytes(const MemoryForecast &frame) const;

  // Measurements from here on are of this. `scene` must outlive them. The reference is always as exact as it
  // can be. Throws Error: also (out_of_memory) where the forecast of a frame does not fit.
  void prepare(const Scene &scene, const Sensor &sensor, const std::vector<Illuminator> &illuminators,
               Backscatter backscatter, Shadows shadows, const Accuracy &accuracy = {},
               const Bounces &bounces = {});
  // The setup, which must outlive it, at its start.
  void prepare(const Setup &setup, const Sensor &sensor, const Accuracy &accuracy = {});
  // As Simulator::path(); nothing of the reference.
  std::vector<std::pair<std::string, std::string>> path() const;
  // One frame, with the noise of the sensor's electronics. `add` adds to its light what comes from elsewhere:
  // from then on its taps are no samples of a sine. Throws Error, interrupted among others.
  using AddLight = std::function<void(Measurement &)>;
  Measurement measure(const Progress &progress = {}, const ExposureNumber &number = {},
                      const AddLight &add = {});
  // The same without electrons and unwrapping: the light that the electronics would read.
  Measurement measure_noiseless(const Progress &progress = {}, const ExposureNumber &number = {},
                                const AddLight &add = {});
  // And without scatter. Neither this, nor measure_noiseless(), nor `add` is for a frame whose electrons the
  // device counts (Extras::electrons_at_once): they throw std::logic_error.
  Measurement measure_light(const Progress &progress = {}, const ExposureNumber &number = {});
  // As Simulator::give_up_device(); nothing for the reference.
  void give_up_device();
  // As Simulator::reuse().
  void reuse(Measurement &&frame);

private:
  std::optional<Simulator> simulator_;                                // empty: the reference
  std::function<reference::Frame(const Progress &)> reference_frame_; // of what is prepared
  // A frame as the device or the reference leaves it.
  Measurement measure_device(const Progress &progress, const ExposureNumber &number);
  // What the light goes through before the electronics read it.
  void add_and_scatter(const AddLight &add, Measurement &measurement) const;
  Measurement measurement_of(const reference::Frame &frame, const ExposureNumber &number) const;
  void ask_for_memory(FrameToForecast frame);

  Extras extras_;
  Sensor sensor_; // that is prepared
  std::uint32_t diode_count_ = 0;
  std::uint64_t granted_bytes_ = 0; // for the device and the frames before
  std::string wanted_, device_, driver_;
};

} // namespace pmdsim
