#pragma once
// One camera, one wall and one ring of diodes, and how far from the ordinary each of their figures can be
// taken.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <cstdint>
#include <vector>

namespace pmdsim::test {

// The wall is Lambertian and fills the view; the ring stands around the lens. As it is here: the middle of
// the matrix.
struct ExtremeSetup {
  double distance_m = 2.0; // of the wall, along the optical axis
  double modulation_hz = 20e6;
  std::uint32_t diodes = 240;
  double ring_radius_m = 0.166;
  double offset_m = 0.0;       // of everything from the world's origin, along each of its axes
  std::uint32_t samples = 1;   // S
  double incidence_deg = 0.0;  // of the optical axis on the wall
  double triangle_m = 0.0;     // edge of the wall's triangles, which then fill the view; 0: two large ones
  double aspect = 1.0;         // how many times longer than wide these are
  bool zero_areas = false;     // triangles without area among them
  double intensity_w_sr = 1.0; // of every diode
  double behind_w_sr = 0.0;    // of a second ring, as far behind the wall as the lens is before it; 0: none
  double over_wall_m = 0.0;    // height of the diodes, spread before the wall; 0: a ring around the lens
  // A second ring of as many diodes whose light arrives half a turn later, by its modulation phase or by its
  // place, half a wavelength behind the lens. `left_over` is what it leaves of the first one's return, on the
  // optical axis.
  enum class Opposed { no, phase, path } opposed = Opposed::no;
  double left_over = 0.0;
};

struct BuiltSetup {
  Scene scene;
  Sensor sensor;
  std::vector<Illuminator> illuminators;
};

// 24 x 24 pixels, down to 2 x 2 where they would take long.
BuiltSetup build(const ExtremeSetup &setup);

} // namespace pmdsim::test
