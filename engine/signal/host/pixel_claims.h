#pragma once
// The use of the errors that some pixels may have: claims.comp, as the pixels are made.

#include "engine/light/host/vector_samples.h"
#include "engine/signal/host/pixel_bounds.h"
#include "engine/signal/host/pixel_loops.h"

#include <algorithm>
#include <cstdint>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

inline Ints keeps(const shader::Frequency &frequency, const Errors &errors) {
  return (errors.distance_m <= frequency.limit_m) & (errors.amplitude <= frequency.amplitude_limit);
}

// Of the vectors of one part of a strip, one after the other.
class HeldPixels {
public:
  explicit HeldPixels(const PixelWork &of) : of_(of) {}

  // One of the returns of each of the vector's pixels; `is_kept`: what was asked for is.
  void add(const VectorSamples &samples, const Errors &errors, const Ints &is_kept) {
    const Floats none = all(0.0f);
    kept_m_ = larger(kept_m_, is_kept ? errors.distance_m : none);
    kept_amplitude_ = larger(kept_amplitude_, is_kept ? errors.amplitude : none);
    const std::uint32_t beyond = bits_of(~is_kept);
    beyond_ |= beyond;
    if (beyond != 0 && !of_.later)
      count(samples, errors, beyond);
  }

  // Lists the pixels that some return is beyond what was asked for of.
  void end_vector(const VectorSamples &samples) {
    if (beyond_ != 0 && of_.later)
      for_each_pixel(samples, beyond_, [&](int lane) {
        const std::uint32_t place = __atomic_fetch_add(of_.later_count, 1u, __ATOMIC_RELAXED);
        of_.later[place] = static_cast<std::uint32_t>(samples.number[lane]);
      });
    beyond_ = 0;
  }

  PixelClaims claims() const {
    PixelClaims claims = claims_;
    claims.kept_m = most_of(kept_m_);
    claims.kept_amplitude = most_of(kept_amplitude_);
    return claims;
  }

private:
  // The last pixel of a row may be there several times.
  template <class Each>
  static void for_each_pixel(const VectorSamples &samples, std::uint32_t bits, const Each &each) {
    for (int lane = 0; lane < lanes; ++lane)
      if ((bits >> lane & 1u) != 0 && (lane == 0 || samples.number[lane] != samples.number[lane - 1]))
        each(lane);
  }

  // An error that is no number counts as 1.
  void count(const VectorSamples &samples, const Errors &errors, std::uint32_t bits) {
    const auto known = [](float error) { return error > 0.0f ? error : 1.0f; };
    for_each_pixel(samples, bits, [&](int lane) {
      ++claims_.returns_beyond;
      claims_.worst_m = std::max(claims_.worst_m, known(errors.distance_m[lane]));
      claims_.worst_amplitude = std::max(claims_.worst_amplitude, known(errors.amplitude[lane]));
    });
  }

  const PixelWork &of_;
  Floats kept_m_ = {}, kept_amplitude_ = {};
  std::uint32_t beyond_ = 0;
  PixelClaims claims_{};
};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
