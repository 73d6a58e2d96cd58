#pragma once
// Random but repeatable cameras.

#include "engine/model/sensor.h"
#include "tests/support/random_scenes.h"

namespace pmdsim::test {

// A chip of 24 x 16 mm, tilted by up to 12 degrees, turned anyhow, off the axis by up to 3 mm, filled in part
// or not, with vignetting or not, and no distortion, Brown and Conrady's or a fisheye's, mild to strong.
// Views of 38 to 240 degrees over the diagonal. The distortion of one in a few folds over inside the image
// (lens_fault()).
Sensor random_camera(Random &random, const glm::uvec2 &resolution);

} // namespace pmdsim::test
