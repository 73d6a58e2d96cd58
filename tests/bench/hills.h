#pragma once
// A scene of a million triangles for which nothing has to be loaded.

#include "engine/model/scene.h"

namespace pmdsim::bench {

// Smooth hills on a floor 0.9 m below a camera at the world's origin that looks along -Z (the default pose),
// balls that hang over them, and a wall behind all.
Scene hills();

} // namespace pmdsim::bench
