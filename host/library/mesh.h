#pragma once
// Scenes from arrays.

#include "engine/model/scene.h"
#include "host/library/pmdsim.h"

namespace pmdsim::library {

// Throws Refusal: an array is missing, a position or a reflectivity is out of its range, an index names
// nothing.
Scene scene_of(const pmdsim_mesh &mesh);

} // namespace pmdsim::library
