#pragma once
// How many frames a second a sequence comes to, with writing and without.

#include "host/bench/timing.h"
#include "host/input/setup/setup.h"

namespace pmdsim {

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
