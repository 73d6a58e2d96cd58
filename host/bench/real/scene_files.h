#pragma once
// Procedural scenes as setups, in memory and as files that other programs can read.

#include "host/bench/real/kinds.h"
#include "host/input/setup/setup.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace pmdsim {

inline constexpr double half_view_tangent = 0.5;

// The kind's scene before a camera of `columns` x `columns` pixels at 20 MHz, in the light of the paper's
// ring whose diodes have the order 3; Lambert's backscatter, with shadows.
Setup setup_of_kind(const SceneKind &kind, std::uint32_t triangles, std::uint32_t columns);

// Where the files of a setup of setup_of_kind() lie.
struct SceneFiles {
  std::filesystem::path setup, scene, diodes;
};

// NAME.json, NAME.gltf, NAME.bin and diodes.csv, which all names share, in the directory, which is made where
// there is none. Throws Error (output).
SceneFiles write_scene_files(const std::filesystem::path &directory, const std::string &name,
                             const Setup &setup);

} // namespace pmdsim
