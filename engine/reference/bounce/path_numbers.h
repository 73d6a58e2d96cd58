#pragma once
// The numbers by which paths of light choose where they go. The first few of every path are spread evenly
// over all paths, as most of the light's variance lies there: a Kronecker sequence by the generalised golden
// ratio (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018), shifted at random, so
// that replicates with shifts of their own are independent. The others are random.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pmdsim::reference {

// G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
class SplitMix {
public:
  explicit SplitMix(std::uint64_t seed) : state_(mixed(seed)) {}

  // At least 0, below 1.
  double next() { return static_cast<double>(mixed(state_ += 0x9e3779b97f4a7c15U) >> 11) * 0x1p-53; }

private:
  static std::uint64_t mixed(std::uint64_t bits) {
    bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ bits >> 27) * 0x94d049bb133111ebU;
    return bits ^ bits >> 31;
  }

  std::uint64_t state_;
};

class PathNumbers {
public:
  // The sample that is seen, and direction and diode of the first two flights.
  static constexpr std::size_t even_dimensions = 7;

  // A series of its own for every seed, the same in every run.
  explicit PathNumbers(std::uint64_t seed) : random_(seed) {
    for (double &number : even_)
      number = random_.next();
  }

  void begin_path() {
    for (std::size_t i = 0; i < even_dimensions; ++i) {
      even_[i] += steps()[i];
      even_[i] -= even_[i] >= 1.0 ? 1.0 : 0.0;
    }
    used_ = 0;
  }

  // At least 0, below 1.
  double next() { return used_ < even_dimensions ? even_[used_++] : random_.next(); }

private:
  // Powers of 1/x, where x^(d + 1) = x + 1 in d dimensions.
  static const std::array<double, even_dimensions> &steps() {
    static const std::array<double, even_dimensions> steps = [] {
      double ratio = 1.0;
      for (int i = 0; i < 100; ++i)
        ratio = std::pow(1.0 + ratio, 1.0 / (even_dimensions + 1.0));
      std::array<double, even_dimensions> powers{};
      double power = 1.0;
      for (double &step : powers)
        step = power /= ratio;
      return powers;
    }();
    return steps;
  }

  SplitMix random_;
  std::array<double, even_dimensions> even_{};
  std::size_t used_ = 0;
};

} // namespace pmdsim::reference
