#pragma once
// Writes a new setup with its scene.

#include "host/start/kinds.h"

#include <filesystem>
#include <string>
#include <vector>

namespace pmdsim {

struct NewSetup {
  const StartKind *kind;
  std::filesystem::path folder;
  StartSizes sizes;
  bool replaces = false; // files of the same names in a folder that is not empty
};

struct NewFiles {
  std::filesystem::path setup, scene;
  std::vector<std::string> all; // paths; the setup is the first
};

// All files, or none. Throws Error (output) where the folder cannot be written, or is not empty and nothing
// is to be replaced.
NewFiles write_new_setup(const NewSetup &wanted);

} // namespace pmdsim
