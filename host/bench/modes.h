#pragma once
// The modes of one setup, checked against the reference and then timed in turn.

#include "host/bench/accuracy_check.h"
#include "host/bench/native/native_bench.h"
#include "host/bench/timing.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pmdsim {

inline constexpr int bench_rounds = 7; // a timed frame of each mode in each

struct ModeBench {
  Mode mode = Mode::exact;
  double first_frame_ms = 0.0;       // from preparing to the result, with the compiling of all that the modes
                                     // before it and the driver's cache have not left
  std::optional<double> prepare_ms;  // again, warm; nothing of the reference
  std::vector<AccuracyCheck> checks; // none of the reference itself
  std::vector<TimedFrame> frames;    // one a round, of all sensors
  std::vector<std::pair<std::string, std::string>> path =
      {}; // of the last sensor's frame (Simulator::path())
};

struct SetupBench {
  std::string name;          // of the rows
  double interactions = 0.0; // of a frame in mode exact: samples x diodes of all sensors and exposures
  bool adaptive = false;     // then a frame has fewer
  std::uint32_t sensors = 1;
  std::vector<ModeBench> modes; // the first is exact unless another one was asked for
  // Only where there is something to compare it with: mode exact of a device with the same samples
  // everywhere.
  std::optional<NativeBench> native;
  // The device's side of that comparison: interactions per second of the accumulate pass over the first
  // sensor's samples, one a round, with each diode in the loop at each sample, as in the native kernel.
  std::vector<double> looped_per_s;
  std::optional<std::int64_t> peak_memory_bytes; // of the process
};

// A mode that cannot keep its error is an error only where it was asked for; else it is left out with a
// warning on stderr. Throws Error.
SetupBench bench_setup(const Setup &setup, const BenchRequest &request, const std::string &name);

// Samples x diodes over the time of the accumulate pass, of each frame; nothing where not every sample meets
// every diode there.
std::vector<double> interactions_per_s(const SetupBench &bench, const ModeBench &mode);

struct Ratio {
  std::string name;
  double value;     // median speed over median speed
  Spread of_rounds; // of the ratios within each round
};

// The ratios accumulate_over_native and accumulate_over_native_series, of the sum in the loop over the
// diodes, and exact_frame_over_MODE_frame, as far as both sides are there.
std::vector<Ratio> ratios_of(const SetupBench &bench);

} // namespace pmdsim
