#pragma once
// Another program that makes the same frames, to be raced.

#include "host/bench/real/scene_files.h"

#include <filesystem>

namespace pmdsim {

// The program is called as
//   PROGRAM SCENE.gltf DIODES.csv --res C R --fov-x-tan T --freq HZ --shadows --threads N --reps K
// where T is the tangent of half the view, and prints a line with "frame_ms X" for each of the K frames that
// it makes.
struct Peer {
  std::filesystem::path program;
  unsigned threads;
};

// The time that it prints for the last of `count` frames of the files' scene. Throws Error (input) where the
// program cannot be run, fails, or prints no such line.
double last_frame_ms(const Peer &peer, const SceneFiles &files, const Sensor &sensor, int count);

} // namespace pmdsim
