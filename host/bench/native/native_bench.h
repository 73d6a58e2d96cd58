#pragma once
// The native kernel beside a setup's frames, in turn with them, as a machine's clock drifts. It sums the
// setup's own points and diodes, or, where the setup is none that it models, those of a ring before a wall.

#include "engine/model/measurement.h"
#include "host/bench/native/native_kernel.h"
#include "host/input/setup/setup.h"

#include <string>
#include <vector>

namespace pmdsim {

// 240 isotropic diodes in five rings of 0.126 to 0.166 m about the lens and 640 x 640 points of a wall of
// 0.4 x 0.4 m, 2 m before it; 20 MHz.
NativeWork ring_and_wall();

struct ChosenWork {
  NativeWork work;
  std::string points; // whose points and diodes they are, for people, and why not the setup's
};

// `measurement` is of `sensor` in the setup's light at its start, in mode exact, with one sample a pixel. The
// sensor's first frequency counts.
ChosenWork native_work(const Setup &setup, const Sensor &sensor, const Measurement &measurement);

// A kernel whose results have been compared with double, and what it came to.
struct NativeBench {
  NativeKernel kernel;
  std::string points; // as in ChosenWork
  double moments_error_m = 0.0;
  const NativeSeries *series = nullptr; // the shortest that does; nothing where it takes too many powers
  double series_error_m = 0.0;
  // Interactions per second of each round; none of the series where there is none.
  std::vector<double> moments_per_s{}, series_per_s{};

  // One round: each form once to warm up and once to be timed.
  void run();
};

// On the ring and the wall where the moments are no good for what was chosen. Throws Error (internal) where
// they are not for these either.
NativeBench checked_bench(const ChosenWork &chosen, const NativeSums &sums, unsigned threads);

// On the setup's own diodes and points where the kernel models them. `device` as Camera's, no reference.
// Throws Error.
NativeBench native_bench(const Setup &setup, const std::string &device);

} // namespace pmdsim
