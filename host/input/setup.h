#pragma once
// A setup file (DESIGN: "The setup file"), loaded and checked once.

#include "engine/illuminator.h"
#include "engine/scene.h"
#include "engine/sensor.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

struct Setup {
  std::filesystem::path file;
  Scene scene;
  Backscatter backscatter = Backscatter::lambert;
  std::vector<Sensor> sensors;           // at least one, each with a name of its own
  std::vector<Illuminator> illuminators; // one until several are supported
  nlohmann::ordered_json as_used;        // the setup with every default filled in, as the manifest shows it
  std::vector<std::string> warnings;     // one line each, for stderr; e.g. that the scene is empty
};

// Throws Error (input) in one line: the file, the place in it and what was expected.
Setup load_setup(const std::filesystem::path &file);

} // namespace pmdsim
