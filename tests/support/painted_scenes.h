#pragma once
// Random but repeatable paint and points for scenes.

#include "tests/support/random_scenes.h"

namespace pmdsim::test {

// Texels of any colour, every channel from 0 to 1.
std::shared_ptr<const Texture> random_texture(Random &random, const glm::uvec2 &size);

// Gives the surfaces random paint: textures with any wrap and filter, vertex colours, alpha masks, or none of
// it; and the vertices texture coordinates from -1.5 to 2.5 and colours.
void paint(Random &random, Scene &scene);

// Adds `count` discs of 2 to 60 mm radius in front of the camera, z 0.8 to 2.5 m in its frame, each with a
// colour of its own if the scene has colours.
void scatter_discs(Random &random, std::size_t count, const Pose &world_from_camera, Scene &scene);

} // namespace pmdsim::test
