#pragma once
// Small files that setups and tables of diodes may name.

#include <filesystem>

namespace pmdsim::fuzz {

// Writes wall.gltf, diodes.csv, led.csv, led.ies, poses.txt and setup.json, which works, into folder(), and
// returns it.
std::filesystem::path write_small_files();

// That setup, and the same without a scene.
extern const char *const small_setup, *const small_setup_without_scene;

} // namespace pmdsim::fuzz
