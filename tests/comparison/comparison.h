#pragma once
// The simulator's frame against the reference's, where both see the same.

#include "engine/reference/reference.h"

#include <string>
#include <vector>

namespace pmdsim::test {

struct Comparison {
  std::size_t samples = 0;
  std::size_t differing_samples = 0; // the two see another triangle there
  std::size_t differing_far_off = 0; // of these, more than a pixel from every edge of both triangles
  std::size_t pixels =
      0; // that see light, and the same triangle in every sample; of all frequencies together
  double distance_max_m = 0.0; // differences over these pixels, wrapped to half the ambiguity distance
  double distance_rms_m = 0.0;
  double amplitude_max_relative = 0.0; // of the amplitude; of the taps, where measured, relative to it
  double range_max_relative = 0.0;     // of range_m and z_m
  std::size_t disagreements =
      0; // pixels with the same triangles where NaN, coverage or an id is not the same

  double differing_fraction() const {
    return static_cast<double>(differing_samples) / static_cast<double>(samples);
  }
};

// `measured` holds its samples' triangles. Pixels marked in `left_out` (empty: none) are not compared in
// distance and amplitude.
Comparison compare(const Measurement &measured, const reference::Frame &expected, const Scene &scene,
                   const Sensor &sensor, const std::vector<bool> &left_out = {});

// The figures of docs/accuracy.md where both see the same; `pixels` of them at least.
void check_values(const Comparison &comparison, std::size_t pixels);
// And that they do nearly everywhere.
void check_comparison(const Comparison &comparison, std::size_t pixels);

// One line a comparison, under a heading.
std::string comparison_heading();
std::string comparison_row(const std::string &name, const Comparison &comparison);

} // namespace pmdsim::test
