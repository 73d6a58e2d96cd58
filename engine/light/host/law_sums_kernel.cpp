// The host's sums over the sources, a lane a sample. Compiled once for each instruction set,
// PMDSIM_INSTRUCTION_SET its name; see engine/CMakeLists.txt.
#include "engine/light/host/vector_sum.h"

#include <algorithm>
#include <cstdint>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

void store_moments(const LawSums &of, const VectorSamples &samples, std::uint32_t run, const Floats *moment) {
  const std::uint32_t planes = of.moments + 1;
  for (std::uint32_t k = 0; k < planes; ++k) {
    float *plane = of.run_moments + (std::size_t{run} * planes + k) * of.plane;
    for (int lane = 0; lane < lanes; ++lane)
      plane[samples.number[lane]] = samples.sees[lane] != 0 ? moment[k][lane] : 0.0f;
  }
}

void sum_vector(const LawSums &of, VectorSamples &samples) {
  find_samples(of.samples, samples);
  find_surfaces(of.samples, samples);
  const int seen = static_cast<int>(std::find(samples.sees, samples.sees + lanes, 1) - samples.sees);
  Floats moment[most_host_sums] = {};
  if (seen < lanes)
    fill_gaps(samples, seen);
  const VectorSum vector(of, samples);
  for (std::uint32_t run = 0; run < of.run_count; ++run) {
    if (seen < lanes)
      vector.sum(of.runs[run], moment);
    store_moments(of, samples, run, moment);
  }
}

void sum_rows(const LawSums &of, std::uint32_t first, std::uint32_t last) {
  const std::uint32_t columns = of.samples.strip.columns;
  for_each_vector_of_rows(columns, {0, columns}, {first, last},
                          [&](VectorSamples &samples) { sum_vector(of, samples); });
}

void sum_blocks(const LawSums &of, std::uint32_t first, std::uint32_t last) {
  for_each_vector_of_blocks(of.blocks, first, last, [&](VectorSamples &samples) { sum_vector(of, samples); });
}

} // namespace

extern const SumLaws sum_laws;
const SumLaws sum_laws{sum_rows, sum_blocks};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
