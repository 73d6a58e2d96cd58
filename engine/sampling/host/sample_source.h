#pragma once
// Where a strip's samples lie, as the device left them, for loops that are compiled once for each instruction
// set and share no code with the rest of the program.

#include "shaders/shared/interface.h"

#include <cstddef>

namespace pmdsim {

struct SampleSource {
  shader::Strip strip;       // of samples, where these are records
  const std::byte *ids;      // records, or IDs
  const std::byte *position; // Real[3] a sample, where these are no records
  const shader::TrianglePlane *planes;
  const shader::ChipPlace *chip; // of records, where the chip is not nominal
  double slope[2];               // of records otherwise
  bool records, has_fp64, tiled;
};

} // namespace pmdsim
