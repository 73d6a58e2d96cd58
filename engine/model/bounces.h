#pragma once
// Light that comes to the lens by more than one surface (multipath), as a setup asks for it.

#include <cstddef>
#include <cstdint>

namespace pmdsim {

inline constexpr std::uint32_t all_bounces = 0xffffffffu;

struct Bounces {
  // How often light may bounce off a surface between the point that a diode lights and the point that the
  // lens sees, that one included: 0 is eq. 5 to 7 alone.
  std::uint32_t count = 0;
  double max_error_m = 1e-3; // of multipath_m, in 95 % of the pixels at least

  bool any() const { return count > 0; }
  bool operator==(const Bounces &) const = default;
};

// What light that bounces will take, told before anything is computed.
struct BouncesForecast {
  std::size_t elements = 0; // of surfaces, at first; more where these turn out to be too coarse
  double frame_s = 0.0;     // about, of a first frame, on this processor
};

} // namespace pmdsim
