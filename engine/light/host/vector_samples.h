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
  std::int32_t shape[lanes]; // that it sees
  std::int32_t sees[lanes];
  double normal[3][lanes], offset_m[lanes]; // of the shape's plane, as in TrianglePlane, by find_surfaces
};

// Finds samples by their numbers.
inline void find_samples(const SampleSource &of, VectorSamples &samples) {
  Place place{0, 0, 0, 0, 0};
  double ray[2][lanes], depth[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    const auto number = static_cast<std::uint32_t>(samples.number[lane]);
    if (lane > 0 && number == place.index + 1 && place.column + 1 < of.strip.columns) {
      ++place.index;
      ++place.column;
    } else if (lane == 0 || number != place.index)
      place = {number % of.strip.columns, number / of.strip.columns, 0, 0, number};
    std::uint32_t shape;
    find_record(of, number, shape, depth[lane]);
    samples.sees[lane] = depth[lane] != 0.0;
    samples.shape[lane] = samples.sees[lane] != 0 ? static_cast<std::int32_t>(shape) : 0;
    ray[0][lane] = from_middle(place.column + of.strip.column, of.strip.resolution_x);
    ray[1][lane] = from_middle(place.row + of.strip.row, of.strip.resolution_y);
  }
  find_points(of, ray[0], ray[1], depth, samples.point_m);
}

inline void find_surfaces(const SampleSource &of, VectorSamples &samples) {
  for (int lane = 0; lane < lanes; ++lane) {
    const shader::TrianglePlane &plane = of.planes[samples.shape[lane]];
    const auto exact = [&](int k) {
      return static_cast<double>(plane.plane_hi[k]) + static_cast<double>(plane.plane_lo[k]);
    };
    for (int k = 0; k < 3; ++k)
      samples.normal[k][lane] = exact(k);
    samples.offset_m[lane] = exact(3);
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
  VectorSamples samples_{};
  int count_ = 0;
};

// Vectors begin with rows: a law may depend on a vector's other samples, and these must be the same however
// strips and threads part them.
struct Stretch {
  std::uint32_t first, last; // excluded
};
template <class Each>
void for_each_vector_of_rows(std::uint32_t columns, const Stretch &of_columns, const Stretch &of_rows,
                             const Each &each) {
  Gathering gathering(each);
  for (std::uint32_t row = of_rows.first; row < of_rows.last; ++row) {
    for (std::uint32_t column = of_columns.first; column < of_columns.last; ++column)
      gathering.add(row * columns + column);
    gathering.end();
  }
}

// Of blocks as BlockLists lists them.
template <class Each>
void for_each_vector_of_blocks(const std::uint32_t *blocks, std::uint32_t first, std::uint32_t last,
                               const Each &each) {
  Gathering gathering(each);
  for (std::uint32_t i = first; i < last; ++i) {
    const std::uint32_t sample = blocks[i] / shader::block_samples;
    for (std::uint32_t k = 0; k <= blocks[i] % shader::block_samples; ++k)
      gathering.add(sample + k);
  }
  gathering.end();
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
