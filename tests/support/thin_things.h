#pragma once
// Rods, points and grass in a camera's view, thinner than its samples lie apart.

#include "engine/model/scene.h"
#include "engine/model/sensor.h"
#include "tests/support/random_scenes.h"

namespace pmdsim::test {

// Rods that stand alone, 1 to 2.5 m off, across the lens's view, 20 to 120 samples long; two triangles each.
Scene rods_in_view(Random &random, std::size_t count, double width_samples, const Sensor &sensor);

// Points that stand alone, 1 to 2.5 m off.
Scene points_in_view(Random &random, std::size_t count, double diameter_samples, const Sensor &sensor);

// Blades, triangles that end in tips, 0.2 to 0.5 m high and a few millimetres wide, on a floor 0.9 m below
// the camera, 1 to 5 m ahead.
Scene grass(Random &random, std::size_t blades, const Sensor &sensor);

} // namespace pmdsim::test
