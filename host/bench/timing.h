#pragma once
// How long frames take, warm, and how many of a sequence there are a second, with writing and without.

#include "engine/model/measurement.h"
#include "host/input/setup/setup.h"
#include "host/report/report.h"

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

// By the clock.
double ms_since(std::chrono::steady_clock::time_point start);

// The device, accuracy and modes that are to be timed.
struct BenchRequest {
  std::string device; // as Camera's
  Accuracy accuracy;
  bool one_mode = false; // that of `accuracy`; else all where a setup is timed
};

// The times and accuracy of one frame; of several sensors all their frames together.
struct TimedFrame {
  double frame_ms = 0.0;
  std::vector<PassTime> passes;
  std::optional<AccuracyReport> accuracy;
};

// Times add up, and the larger error counts; no error is known where one of the two is not.
void add(TimedFrame &sum, const Measurement &measurement);

// The time of the pass `name`; NaN where the frame has none.
double pass_ms(const TimedFrame &frame, std::string_view name);

struct Timing {
  Spread frame_ms{0.0, 0.0, 0.0};
  std::vector<PassTime> passes; // medians, in the order of the frame
  double passes_explain = 0.0;  // the passes' sum over the frame's time, median
  AccuracyReport accuracy;      // of the last frame
};

// The timing of at least one frame.
Timing timing_of(std::span<const TimedFrame> frames);

// Samples x diodes over the time of the accumulate pass, median; NaN where not all of them meet there.
double interactions_per_s(std::span<const TimedFrame> frames, double interactions, Mode mode);

// Whole frames, all sensors of each, by the clock: from the first's measurement to the last's publication.
struct SequenceRate {
  double measured_per_s; // nothing written
  double npy_per_s;      // NPY
  double exr_per_s;      // EXR
  std::uint32_t frames;  // that each is the rate of
};

// Runs that many frames of the setup, at its rate and from its start whatever its own count is, as `render`
// does, on the device and in the mode that are asked for. One frame goes before, which compiles what is not
// compiled yet. The files are new, in a temporary directory that is removed, however this ends. Throws Error,
// interrupted among others.
SequenceRate measure_sequence_rate(const Setup &setup, const BenchRequest &request, std::uint32_t frames);

} // namespace pmdsim
