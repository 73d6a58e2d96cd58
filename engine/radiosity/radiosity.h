#pragma once
// The light that bounces between the surfaces of a scene: radiosity with complex values (C. M. Goral and
// others, "Modeling the interaction of light between diffuse surfaces", SIGGRAPH 1984; docs/theory.md,
// "Light that bounces"). It knows no camera: one solution serves all sensors.

#include "engine/model/bounces.h"
#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/radiosity/bounce_tones.h"
#include "engine/radiosity/exitance.h"
#include "engine/surfaces/hemisphere_scan.h"

#include <memory>
#include <vector>

namespace pmdsim {

// How finely surfaces and directions are cut.
struct Fineness {
  double element_m;    // across an element
  std::uint32_t lines; // from each of its places
  std::uint32_t bins;  // of a line, whoever looks along it
  double facet_part;   // a facet is cut where it may be off by this part of all light that leaves surfaces
};

struct Radiosity {
  Elements elements;
  std::unique_ptr<const HemisphereScan> scan; // of the elements
  Exitance exitance; // of all that leaves towards the lens's last surface: direct and bounces but one
  // What all light together may be off by, of each tone, as a part of what arrives anywhere.
  std::vector<float> off;
  std::size_t lines = 0; // along which was looked
  std::uint32_t products = 0;
};

// `scene` has to outlive the result. Throws Error: input ("all" diverges: nothing is lost in a closed scene
// that reflects everything), out_of_memory.
Radiosity solve_radiosity(const Scene &scene, const std::vector<Illuminator> &illuminators, Shadows shadows,
                          const Bounces &bounces, const std::vector<BounceTone> &tones,
                          const Fineness &fineness);

} // namespace pmdsim
