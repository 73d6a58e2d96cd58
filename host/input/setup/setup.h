#pragma once
// A setup file (docs/setup.md), loaded and checked once.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// What there is at one time.
struct Instant {
  Scene scene;
  std::vector<Sensor> sensors;           // at least one, each with a name of its own
  std::vector<Illuminator> illuminators; // at least one, each with a name of its own
};

// When frames are taken.
struct FrameTimes {
  double start_s = 0.0;
  double rate_hz = 1.0;
  std::uint32_t count = 1;

  double time_s(std::uint32_t frame) const { return start_s + frame / rate_hz; }
};

// How the scene, the sensors and the illuminators move.
class Motion;

struct Setup {
  std::filesystem::path file;
  Backscatter backscatter = Backscatter::lambert;
  Shadows shadows = Shadows::automatic;
  FrameTimes frames;
  Instant start;                        // at the first frame's time
  nlohmann::ordered_json as_used;       // the setup with every default filled in, as the manifest shows it
  std::vector<std::string> warnings;    // one line each, for stderr; e.g. that the scene is empty
  std::shared_ptr<const Motion> motion; // nothing where all stands still

  // Everything in its place at a time; `start` where nothing moves. Throws Error (input).
  Instant at(double time_s) const;
};

// Throws Error (input) in one line: the file, the place in it and what was expected.
Setup load_setup(const std::filesystem::path &file);

} // namespace pmdsim
