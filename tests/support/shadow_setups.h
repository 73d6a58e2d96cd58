#pragma once
// Random but repeatable scenes where anything may stand in anything's light.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <cstdint>
#include <vector>

namespace pmdsim::test {

struct ShadowSetup {
  Scene scene;
  Sensor sensor;
  std::vector<Illuminator> illuminators;
};

// 24 x 24 pixels that see 1 to 2,000 triangles, slivers and big ones, loose, in welded grids, in one plane
// and in stacks close to each other, most before a background; masks and discs in a part of the scenes. 1 to
// 300 diodes in one to three rings, lines and clouds around the lens, in the midst of the scene or far from
// it.
ShadowSetup random_shadow_setup(std::uint32_t seed);

} // namespace pmdsim::test
