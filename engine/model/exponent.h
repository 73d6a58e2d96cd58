#pragma once
// A real exponent, at least 0, as sums take it: so many products, and a rest below 1 by the logarithm.

#include <cmath>
#include <cstdint>

namespace pmdsim {

struct Exponent {
  std::uint32_t whole = 0;
  float rest = 0.0f;
};

inline Exponent exponent_of(double value) {
  const double whole = std::floor(value);
  return {static_cast<std::uint32_t>(whole), static_cast<float>(value - whole)};
}

} // namespace pmdsim
