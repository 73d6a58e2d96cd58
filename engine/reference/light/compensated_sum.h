#pragma once
// Sums whose rounding error does not grow with the number of terms.

#include <cmath>
#include <complex>

namespace pmdsim::reference {

// A. Neumaier, "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen", ZAMM 54 (1974).
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

} // namespace pmdsim::reference
