#pragma once
// Which diodes reach which sample: the simulator's answer against the reference's, pair by pair.

#include "engine/reference/reference.h"

#include <string>
#include <vector>

namespace pmdsim::test {

struct ReachedComparison {
  std::size_t samples = 0; // that see the same shape in both
  std::size_t pairs = 0;   // these samples times the diodes
  std::size_t reached = 0; // of the pairs, says the reference
  std::size_t differing_pairs = 0;
  // The differing pairs whose line from sample to diode clears every edge by more than rounding_distance_m;
  // and those of them neither of whose line's ends lies as close to another shape.
  std::size_t clear_of_edges = 0, clear_of_all = 0;
  std::vector<bool> differing_pixels; // where any pair of any sample differs
  double lit_error = 0.0; // the largest difference between `lit` and the simulator's own count of its pairs

  double differing_fraction() const {
    return pairs > 0 ? static_cast<double>(differing_pairs) / static_cast<double>(pairs) : 0.0;
  }
};

// Both hold their samples' triangles and which diodes reach them.
ReachedComparison compare_reached(const Measurement &measured, const reference::Frame &expected,
                                  const Scene &scene, const Sensor &sensor,
                                  const std::vector<Illuminator> &illuminators);

// The share of pixels whose distances differ by 3 micrometres at most, among those that either sees lit.
double share_of_pixels_agreeing(const Measurement &measured, const reference::Frame &expected);

// One line a comparison, under a heading.
std::string reached_heading();
std::string reached_row(const std::string &name, const ReachedComparison &comparison);

} // namespace pmdsim::test
