#pragma once
// How long frames take, warm.

#include "engine/measurement.h"
#include "host/commands/report.h"

#include <functional>
#include <string>
#include <vector>

namespace pmdsim {

inline constexpr int measured_frames = 7;

// Of one sensor's frames or, summed, of all sensors' frames.
struct Timing {
  Spread frame_ms{0.0, 0.0, 0.0};
  std::vector<PassTime> passes; // medians, in the order of the frame
  AccuracyReport accuracy;      // of the last frame
};

// Calls `measure` with what it does, for people: once to warm up and measured_frames times to be timed.
Timing time_frames(const std::function<Measurement(const std::string &label)> &measure);

// Times add up, and the larger error counts; nothing is known of it where nothing is of either's.
void add(Timing &sum, const Timing &timing);

} // namespace pmdsim
