#pragma once
// Random but repeatable measured diagrams.

#include "engine/model/illuminator.h"
#include "tests/support/random_scenes.h"

#include <memory>

namespace pmdsim::test {

// Even steps of both angles, or uneven ones, smooth enough that a sample at an angle's edge does not jump; 0
// beyond 90 degrees. `axial`: the same all around.
std::shared_ptr<const Diagram> random_diagram(Random &random, bool axial);

} // namespace pmdsim::test
