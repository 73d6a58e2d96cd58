#pragma once
// The light that leaves each side of each facet, W/m^2, for every tone: rho times the irradiance, direct and
// bounced, linear over the facet; and by how much that misses what was found at its centre.

#include "engine/radiosity/face_light.h"

#include <cstddef>
#include <vector>

namespace pmdsim {

class Exitance {
public:
  Exitance(std::size_t facets, std::size_t tones) : of_tones_(tones, OfFaces(2 * facets + 1)) {}

  // The faces of a tone; those that nothing leaves are 0, as is one more behind the last.
  using OfFaces = std::vector<FaceLight>;
  const OfFaces &of_tone(std::size_t tone) const { return of_tones_[tone]; }
  FaceLight &of(std::size_t face, std::size_t tone) { return of_tones_[tone][face]; }
  const FaceLight &of(std::size_t face, std::size_t tone) const { return of_tones_[tone][face]; }

private:
  std::vector<OfFaces> of_tones_;
};

} // namespace pmdsim
