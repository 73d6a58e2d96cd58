#pragma once
// The samples of a vector: where they are, what surface they see, and how they come together.

#include "engine/light/host/law_sums.h"
#include "engine/model/lanes.h"
#include "engine/sampling/host/sample_points.h"

#include <algorithm>
#include <cstdint>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// Camera frame.
struct VectorSamples {
  std::int32_t number[lanes];
  double point_m[3][lanes];
  double normal[3][lanes], offset_m[lanes]; // of the surface's plane, as in TrianglePlane
  std::int32_t sees[lanes];
};

inline void find_surface(const shader::TrianglePlane &plane, int lane, VectorSamples &samples) {
  const auto exact = [&](int k) {
    return static_cast<double>(plane.plane_hi[k]) + static_cast<double>(plane.plane_lo[k]);
  };
  for (int k = 0; k < 3; ++k)
    samples.normal[k][lane] = exact(k);
  samples.offset_m[lane] = exact(3);
}

// Finds samples by their numbers.
inline void find_samples(const SampleSource &of, VectorSamples &samples) {
  Place place{0, 0, 0, 0, 0};
  for (int lane = 0; lane < lanes; ++lane) {
    const auto number = static_cast<std::uint32_t>(samples.number[lane]);
    if (lane > 0 && number == place.index + 1 && place.column + 1 < of.strip.columns) {
      ++place.index;
      ++place.column;
    } else if (lane == 0 || number != place.index)
      place = {number % of.strip.columns, number / of.strip.columns, 0, 0, number};
    double point[3];
    std::uint32_t shape;
    find_point(of, place, point, shape);
    for (int k = 0; k < 3; ++k)
      samples.point_m[k][lane] = point[k];
    samples.sees[lane] = point[2] != 0.0;
    find_surface(of.planes[samples.sees[lane] != 0 ? shape : 0], lane, samples);
  }
}

// Samples that see nothing take the place of `seen`, so that all are near each other.
inline void fill_gaps(VectorSamples &samples, int seen) {
  for (int lane = 0; lane < lanes; ++lane)
    if (samples.sees[lane] == 0)
      for (int k = 0; k < 3; ++k)
        samples.point_m[k][lane] = samples.point_m[k][seen];
}

// Samples one by one, to `sum` vector by vector.
template <class Sum>
class Gathering {
public:
  explicit Gathering(const Sum &sum) : sum_(sum) {}

  void add(std::uint32_t number) {
    samples_.number[count_++] = static_cast<std::int32_t>(number);
    if (count_ == lanes)
      end_vector();
  }
  // The last sample stands for those that are missing.
  void end() {
    if (count_ == 0)
      return;
    std::fill(samples_.number + count_, samples_.number + lanes, samples_.number[count_ - 1]);
    end_vector();
  }

private:
  void end_vector() {
    sum_(samples_);
    count_ = 0;
  }

  const Sum &sum_;
  VectorSamples samples_;
  int count_ = 0;
};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
