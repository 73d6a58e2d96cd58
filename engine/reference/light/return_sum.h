#pragma once
// A pixel's return at one modulation frequency: the paper's eq. 5 to 7, or the correlation samples of another
// waveform.

#include "engine/model/sensor.h"
#include "engine/reference/light/light_paths.h"

#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

namespace pmdsim::reference {

// A sum whose rounding error does not grow with the number of terms: A. Neumaier, "Rundungsfehleranalyse
// einiger Verfahren zur Summation endlicher Summen", ZAMM 54 (1974).
class CompensatedSum {
public:
  void add(double term) {
    const double sum = sum_ + term;
    lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - sum) + term : (term - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return sum_ + lost_; }

private:
  double sum_ = 0.0;
  double lost_ = 0.0;
};

class ComplexSum {
public:
  void add(const std::complex<double> &term) {
    real_.add(term.real());
    imaginary_.add(term.imag());
  }
  std::complex<double> value() const { return {real_.value(), imaginary_.value()}; }

private:
  CompensatedSum real_, imaginary_;
};

// The correlation function C (docs/theory.md, "The measurement") at the phase 2 pi `turns`.
double correlation(const Waveform &waveform, double turns);

// What a pixel returns at one modulation frequency.
struct MeanReturn {
  std::complex<double> z;     // (2/N) sum over k of tap k exp(+j 2 pi k / N)
  std::vector<double> taps;   // c_k, k = 0 ... N-1
  double weight;              // of all paths, whatever their phase
  double mean_radiance = 0.0; // of their light, W/(m^2 sr)
};

// Sums over light paths, before they are divided by the number of samples. A sine's paths are summed as
// phasors, which is exact; any other waveform's tap by tap.
class ReturnSum {
public:
  // Keeps a reference to the sensor.
  ReturnSum(const Sensor &sensor, double modulation_hz);

  void add(const std::vector<LightPath> &paths);

  // Of each of `samples` samples or paths.
  MeanReturn mean(std::uint32_t samples) const;

private:
  std::complex<double> z() const;
  double tap(std::uint32_t k) const;
  double phase_turns(const LightPath &path) const; // -1/2 to 3/2
  bool is_sine() const { return sensor_->waveform.kind == Waveform::Kind::sine; }

  const Sensor *sensor_;
  double turns_per_m_;
  CompensatedSum weight_, mean_radiance_;
  ComplexSum phasors_;               // a sine's
  std::vector<CompensatedSum> taps_; // any other waveform's
};

} // namespace pmdsim::reference
