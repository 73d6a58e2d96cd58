#pragma once
// The native kernel beside a setup's frames, in turn with them, as a machine's clock drifts.

#include "host/bench/native/kernel_work.h"

#include <string>
#include <vector>

namespace pmdsim {

class NativeBench {
public:
  // On the setup's own diodes and points where the kernel models them. `device` as Camera's, no
  // reference. Throws Error.
  NativeBench(const Setup &setup, const std::string &device);

  // One round: each form once to warm up and once to be timed.
  void run();

  const CheckedKernel &checked() const { return checked_; }
  // Interactions per second of each round; none of the series where it has no error.
  const std::vector<double> &moments_per_s() const { return moments_per_s_; }
  const std::vector<double> &series_per_s() const { return series_per_s_; }

private:
  double rate(NativeForm form);

  CheckedKernel checked_;
  std::vector<double> moments_per_s_, series_per_s_;
};

} // namespace pmdsim
