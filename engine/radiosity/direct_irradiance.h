#pragma once
// The complex irradiance of a place on a surface by all diodes: sum over m of V I J cos / r^2 times the
// phasor of the way from the diode, W/m^2, one by one and in double.

#include "engine/model/illuminator.h"
#include "engine/radiosity/bounce_tones.h"
#include "engine/radiosity/phasor.h"
#include "engine/surfaces/facet_tree.h"

#include <span>
#include <vector>

namespace pmdsim {

class DirectIrradiance {
public:
  // `tree` is empty with Shadows::off. Diodes come from the world, places from `origin_m`.
  DirectIrradiance(const std::vector<Illuminator> &illuminators, const glm::dvec3 &origin_m,
                   const FacetTree *tree, double clearance_m);

  // Sets `irradiance`, one value a tone. Any number of threads may call this at once.
  void at(const SurfacePlace &place, std::span<const BounceTone> tones, std::span<Phasor> irradiance) const;

private:
  struct Source {
    Diode diode; // metres from the origin of places
    double phase_turns, modulation_depth;
  };

  std::vector<Source> sources_;
  std::vector<glm::vec3> positions_m_;
  const FacetTree *tree_;
  double clearance_m_;
};

} // namespace pmdsim
