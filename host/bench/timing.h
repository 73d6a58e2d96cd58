#pragma once
// How long frames take, warm.

#include "engine/model/measurement.h"
#include "host/report/report.h"

#include <chrono>
#include <string_view>

namespace pmdsim {

// By the clock.
double ms_since(std::chrono::steady_clock::time_point start);

// What shall be timed, and how.
struct BenchRequest {
  std::string device; // as Camera's
  Accuracy accuracy;
  bool one_mode = false; // that of `accuracy`; else all where a setup is timed
};

// What one frame took; of several sensors all their frames together.
struct TimedFrame {
  double frame_ms = 0.0;
  std::vector<PassTime> passes;
  std::optional<AccuracyReport> accuracy;
};

// Times add up, and the larger error counts; nothing is known of it where nothing is of either's.
void add(TimedFrame &sum, const Measurement &measurement);

// Of the pass `name`; NaN where the frame has none.
double pass_ms(const TimedFrame &frame, std::string_view name);

struct Timing {
  Spread frame_ms{0.0, 0.0, 0.0};
  std::vector<PassTime> passes; // medians, in the order of the frame
  double passes_explain = 0.0;  // the passes' sum over the frame's time, median
  AccuracyReport accuracy;      // of the last frame
};

// Of at least one frame.
Timing timing_of(std::span<const TimedFrame> frames);

} // namespace pmdsim
