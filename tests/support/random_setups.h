#pragma once
// Random but repeatable setups of every kind there is, small enough for the reference.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pmdsim::test {

struct RandomSetup {
  Scene scene;
  Sensor sensor;
  std::vector<Illuminator> illuminators;
  Backscatter backscatter = Backscatter::lambert;
  Shadows shadows = Shadows::off;
  double max_error_m = 0.0;       // 1 micrometre to 10 mm
  std::vector<std::string> kinds; // what it is, for tables: "ring", "narrow beams", "room", ...
};

// Rings, discs, bars, grids and clusters of 1 to 2000 diodes, with diagrams of each form and axes straight or
// tilted, in one or two illuminators that may have a phase; walls, rooms and loose triangles, in shadow or
// not; 1 to 3 frequencies of 1 to 200 MHz, sines mostly; up to 4 x 4 samples a pixel; some lenses with
// distortion, tilted chips and pixels filled in part. Up to 32 x 32 pixels, fewer where there is much to sum.
// Sixteen consecutive seeds share what shaders are compiled for: waveform, number of frequencies and
// illuminators, kinds of diagrams, backscatter, shadows.
RandomSetup random_setup(std::uint32_t seed);

} // namespace pmdsim::test
