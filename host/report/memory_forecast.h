#pragma once
// What memory a frame takes, told before any of it is taken.

#include "engine/model/bounces.h"
#include "engine/model/error.h"
#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pmdsim {

struct MemoryPart {
  std::string what; // "the scene on the device"
  std::uint64_t bytes;
};

// Beside the setup, which is there already.
struct MemoryForecast {
  std::vector<MemoryPart> parts; // those that are 0 are left out

  std::uint64_t bytes() const;
  const MemoryPart &largest() const; // there is one
};

// Who measures: a device in the host's memory, as lavapipe is, one with memory of its own, or the reference.
enum class MeasuredBy { device_in_host, device_apart, reference };

// What is measured, and how.
struct FrameToForecast {
  const Scene &scene;
  const Sensor &sensor;
  const std::vector<Illuminator> &illuminators;
  Bounces bounces;
  std::size_t frame_bytes = 0; // of all its channels
  MeasuredBy by = MeasuredBy::device_in_host;
  std::size_t elements = 0;            // of surfaces between which light bounces
  std::uint32_t max_strip_samples = 0; // as SimulatorOptions: 0, the usual
  std::size_t frames_at_once = 1;      // one is measured while another is written
  bool is_written = false;             // to files
  std::size_t made_bytes = 0;          // of what is made of the channels, to be written with them
  bool moves = false;                  // the next instant is computed while one is measured
};

// The part of every forecast for a device that its driver, its compiled passes and its threads take, once.
inline constexpr std::uint64_t bytes_of_device = 50'000'000;

// Of the host's memory, at the peak of a frame's measurement. Tests compare it with the peaks of setups of
// many kinds, for which it is right within a factor of 2, and not much too low.
MemoryForecast forecast_memory(const FrameToForecast &frame);

// "310 MB for the scene on the device, 200 MB for ...", the largest first.
std::string memory_text(const MemoryForecast &forecast);

// "a frame of the sensor tof NEEDS", what of it takes the most, and what can be done about it.
Error lacking_memory(const Sensor &sensor, const MemoryForecast &forecast, const std::string &lack);

} // namespace pmdsim
