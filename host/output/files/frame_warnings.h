#pragma once
// Warnings of many frames, each told once.

#include "engine/model/warning.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pmdsim {

class FrameWarnings {
public:
  // `warning` is of the frame of that number, its place the sensor alone.
  void add(const Warning &warning, std::uint32_t frame);
  // In the order in which they came, with the first frame of each and how many more have it.
  std::vector<Warning> merged() const;

private:
  struct OfFrames {
    Warning warning; // of the first
    std::uint32_t first, last;
    std::size_t count;
  };
  std::vector<OfFrames> all_;
  std::map<std::pair<std::string, std::string>, std::size_t> place_of_; // in all_, by code and place
};

} // namespace pmdsim
