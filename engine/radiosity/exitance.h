#pragma once
// The light that leaves each side of each facet, W/m^2, for every tone: rho times the irradiance, direct and
// bounced, linear over the facet; and by how much
// that misses what was found at its centre.

#include "engine/radiosity/phasor.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pmdsim {

struct FaceLight {
  std::array<Phasor, 3> corners;
  float missed = 0.0f; // |z| at the centre
};

class Exitance {
public:
  Exitance(std::size_t facets, std::size_t tones) : tones_(tones), light_(2 * facets * tones) {}

  std::size_t tones() const { return tones_; }
  FaceLight &of(std::size_t face, std::size_t tone) { return light_[face * tones_ + tone]; }
  const FaceLight &of(std::size_t face, std::size_t tone) const { return light_[face * tones_ + tone]; }

private:
  std::size_t tones_;
  std::vector<FaceLight> light_; // dark sides are 0
};

// At the place of a facet with those weights of its second and third corner.
inline Phasor at(const std::array<Phasor, 3> &corners, float u, float v) {
  return (1.0f - u - v) * corners[0] + u * corners[1] + v * corners[2];
}

} // namespace pmdsim
