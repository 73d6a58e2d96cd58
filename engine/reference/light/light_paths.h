#pragma once
// The terms of the paper's eq. 5 to 7: the ways that light takes from the diodes through one point of the
// scene to the lens.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/reference/surface_point.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace pmdsim::reference {

inline constexpr double full_turn_rad = 2.0 * std::numbers::pi;

// Some of the diodes, counted through all illuminators.
class DiodeSet {
public:
  // An empty set, with room for `diodes` diodes.
  explicit DiodeSet(std::size_t diodes) : words_((diodes + 31) / 32) {}

  void add(std::size_t diode) { words_[diode / 32] |= 1U << diode % 32; }
  bool has(std::size_t diode) const { return (words_[diode / 32] >> diode % 32 & 1U) != 0; }
  std::size_t count() const {
    std::size_t count = 0;
    for (const std::uint32_t word : words_)
      count += static_cast<std::size_t>(std::popcount(word));
    return count;
  }
  // As Measurement::sample_visibility holds them.
  const std::vector<std::uint32_t> &words() const { return words_; }

private:
  std::vector<std::uint32_t> words_;
};

struct LightPath {
  double length_m;               // r_nm + r_n, and what lies between where light bounces
  double weight_w_m2_sr;         // as of LightReturn
  double phase_turns = 0.0;      // added to what the length makes of it, -1/2 to 1/2
  double modulation_depth = 1.0; // of the light: its mean is the weight over that
};

// What one diode returns through a point, if nothing is between.
struct LightReturn {
  double diode_range_m;  // r_nm
  double weight_w_m2_sr; // lens_gain * B * I * J / r_nm^2
};

LightReturn light_return(const SurfacePoint &point, const Diode &diode, Backscatter backscatter);

// Diodes of one illuminator, camera frame.
struct Light {
  std::vector<Diode> diodes;
  double phase_turns; // -1/2 to 1/2
  double modulation_depth = 1.0;
};

// The paths from every diode of `reached` whose light returns through `point`.
std::vector<LightPath> light_paths(const SurfacePoint &point, const std::vector<Light> &lights,
                                   const DiodeSet &reached, Backscatter backscatter);

} // namespace pmdsim::reference
