#pragma once
// What a pixel's light becomes at one modulation frequency: the paper's eq. 5 to 7, or the correlation
// samples of another waveform.

#include "engine/model/sensor.h"
#include "engine/reference/light/compensated_sum.h"
#include "engine/reference/light/diagram.h"
#include "engine/reference/light/light_paths.h"

#include <complex>
#include <cstdint>
#include <vector>

namespace pmdsim::reference {

// The correlation function C (docs/theory.md, "The measurement") at the phase 2 pi `turns`.
double correlation(const Waveform &waveform, double turns);

// Sums over light paths, before they are divided by the number of samples. A sine's paths are summed as
// phasors, which is exact; any other waveform's tap by tap.
class ReturnSum {
public:
  // Keeps a reference to the sensor.
  ReturnSum(const Sensor &sensor, double modulation_hz);

  void add(const std::vector<LightPath> &paths);

  std::complex<double> z() const; // (2/N) sum over k of tap(k) exp(+j 2 pi k / N)
  double tap(std::uint32_t k) const;
  double weight() const { return weight_.value(); } // of all paths, whatever their phase

private:
  double phase_turns(const LightPath &path) const; // -1/2 to 3/2
  bool is_sine() const { return sensor_->waveform.kind == Waveform::Kind::sine; }

  const Sensor *sensor_;
  double turns_per_m_;
  CompensatedSum weight_;
  ComplexSum phasors_;               // a sine's
  std::vector<CompensatedSum> taps_; // any other waveform's
};

} // namespace pmdsim::reference
