#pragma once
// The sum over the diodes in plain C++ on every core: the yardstick for the accumulate pass. Isotropic diodes
// in phase, none of them hidden, constant backscatter, a sine.

#include "host/bench/native/kernel_sums.h"

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// As many threads as Vulkan on the CPU takes: LP_NUM_THREADS where it is set, 1 at least; else the
// hardware's.
unsigned native_threads();

// The inner loops for the instruction sets that this processor has, the best first.
std::vector<const NativeSums *> available_native_sums();

// The points and the diodes of a sum. Places are relative to any origin, the same for both.
struct NativeWork {
  std::vector<glm::dvec3> points_m; // at least one, none of them at the diodes' middle
  struct Source {
    glm::dvec3 position_m;
    double intensity_w_sr;
  };
  std::vector<Source> diodes; // at least one of intensity above 0
  double modulation_hz = 20e6;
};

class NativeKernel {
public:
  NativeKernel(const NativeWork &work, const NativeSums &sums, unsigned threads);

  double interactions() const; // points x diodes
  std::size_t points() const { return points_; }
  std::size_t diodes() const { return diodes_.size(); }
  unsigned threads() const { return threads_; }
  const NativeSums &sums() const { return *sums_; }

  // Sums once, by one of sums(), and returns the seconds that it took.
  double run_s(NativeSum sum);
  // The largest distance error of what was summed last, against double, at some thousand points spread
  // evenly.
  double error_max_m() const;

private:
  // The phase at one point, relative to the way over the diodes' middle, in double.
  double true_phase_rad(std::size_t point) const;
  void sum_tiles(NativeSum sum, std::size_t first, std::size_t end);

  const NativeSums *sums_;
  unsigned threads_;
  double wavenumber_per_m_;
  std::vector<NativeTile> tiles_; // the last one filled up with its last point
  std::vector<NativeDiode> diodes_;
  std::size_t points_;
  std::vector<float> phases_rad_; // of all points of the tiles
};

} // namespace pmdsim
