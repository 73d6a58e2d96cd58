#pragma once
// What errors of diodes do to the distances of a setup's sensor: linear theory over the image, random boards
// at some of its pixels.

#include "engine/tolerance/tolerances.h"
#include "host/input/setup/setup.h"
#include "host/output/tables/diode_study.h"

#include <cstdint>
#include <functional>
#include <string>

namespace pmdsim {

struct DiodeRequest {
  Tolerances tolerances{};
  std::uint32_t boards = 4000; // at least two
  std::uint64_t seed = 0;
  std::uint32_t pixels = 64; // at most so many columns and rows are looked at
  std::string sensor{};      // its name; empty: the first
};

// Of the first frequency, at the setup's start. A pixel is one ray, that of its centre. `progress` is called
// with what is being done and the fraction of it; may throw to stop. Throws Error: usage (there is no such
// sensor), input (no light returns).
using StudyProgress = std::function<void(const char *what, double fraction)>;
DiodeStudy study_diodes(const Setup &setup, const DiodeRequest &request, const StudyProgress &progress);

// The points that pixels of the sensor see, and the diodes that light them, by the reference. Pixels that see
// nothing are left out: `numbers` has those, of `pixels`, of the points.
LitView lit_view(const Setup &setup, const Sensor &sensor, const std::vector<std::uint32_t> &pixels,
                 std::vector<std::size_t> &numbers, const std::function<void(double)> &progress = {});

} // namespace pmdsim
