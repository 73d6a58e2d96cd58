#pragma once
// What light that bounces adds to a frame whose taps are exposures of their own, each with its own bounces.

#include "engine/model/measurement.h"
#include "engine/model/sensor.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace pmdsim {

// Gathers, exposure by exposure, what of each tap came without bouncing. An exposure tells amplitude A and
// phase phi of that; for a sine its tap k is A cos(phi - 2 pi k / N). Of another waveform A and phi do not
// tell its taps, so such frames have no channels of multipath.
class BouncesOfTaps {
public:
  // `sensor` is the frame's, with all of its frequencies, and outlives this.
  explicit BouncesOfTaps(const Sensor &sensor) : sensor_(sensor) {}

  // The exposure that gives the tap of the frequency, which it measured alone. In the order of taps.
  void add(const Measurement &exposure, std::size_t frequency, std::size_t tap);
  // Fills the channels of multipath in what the frequency returns, its unrounded distance among it, from all
  // of its exposures since the last call; multipath_error_m is the largest of theirs.
  void finish(Return &of_frequency, std::size_t frequency);
  // All exposures together; the error claimed is the largest that one of the first frequency claims, NaN
  // where there are no channels of multipath. Nothing where no light bounces.
  const std::optional<BouncesReport> &report() const { return report_; }

private:
  const Sensor &sensor_;
  std::vector<std::vector<float>> direct_taps_; // of the frequency so far
  std::vector<float> error_m_;
  std::optional<BouncesReport> report_;
};

} // namespace pmdsim
