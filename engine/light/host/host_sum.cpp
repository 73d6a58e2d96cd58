#include "engine/light/host/host_sum.h"

#include "engine/light/host/source_batches.h"
#include "engine/model/instruction_sets.h"
#include "engine/sampling/host/host_samples.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/shader_module.h"

#include <algorithm>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::SumSamples, sum_laws)

namespace pmdsim {

namespace {

constexpr std::size_t most_sums = 32; // of a sample

class HostSum {
public:
  HostSum(const PassSetup &on, const SourceGroups &groups, const ChipGrid &records, bool shadowed)
      : buffers_(on.buffers), samples_(on.buffers, on.scene.planes, on.sensor, records,
                                       vulkan::uses_fp64(on.device, on.options.precision)),
        batches_(groups, bundles_per_run(groups) * shader::diodes_per_bundle),
        powers_(groups.polynomials.powers), shining_(shining_diodes(groups)),
        lambert_(on.model.backscatter == shader::backscatter_lambert), shadowed_(shadowed),
        sum_samples_(widest_sum_laws(on.options.host_vector_bits)) {}

  void sum(const shader::Strip &strip) const {
    const LawSums sums = sums_of(strip);
    const std::uint32_t samples = sums.samples.strip.columns * sums.samples.strip.rows;
    const std::uint32_t parts = (samples + samples_per_part - 1) / samples_per_part;
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, parts, 16), [&](const auto &range) {
      sum_samples_(sums, range.begin() * samples_per_part, std::min(samples, range.end() * samples_per_part));
    });
  }

private:
  LawSums sums_of(const shader::Strip &strip) const {
    return {.samples = samples_.of(strip),
            .runs = batches_.runs().data(),
            .run_count = static_cast<std::uint32_t>(batches_.runs().size()),
            .powers = powers_,
            .lambert = lambert_,
            .visibility = shadowed_ ? buffers_.visibility.mapped_as<std::uint32_t>() : nullptr,
            .lit = shadowed_ ? buffers_.lit.mapped_as<std::uint32_t>() : nullptr,
            .shining = shining_,
            .plane = sample_count(strip),
            .sums = buffers_.run_sums.mapped_as<float>()};
  }

  const StripBuffers &buffers_;
  HostSamples samples_;
  SourceBatches batches_;
  std::uint32_t powers_, shining_;
  bool lambert_, shadowed_;
  SumSamples sum_samples_;
};

} // namespace

bool can_sum_on_host(const SourceGroups &groups) {
  const std::uint32_t powers = groups.polynomials.powers;
  return powers > 0 && powers <= most_host_powers && powers * groups.runs.size() <= most_sums &&
         std::ranges::any_of(groups.diodes, has_diagram) &&
         std::ranges::all_of(groups.diodes, is_known_to_host);
}

Pass host_sum_pass(const PassSetup &on, const SourceGroups &groups, const ChipGrid &records, bool shadowed) {
  const auto sum = std::make_shared<const HostSum>(on, groups, records, shadowed);
  return {.name = "accumulate",
          .reads = shadowed ? ids | visibility_bits | visibility_counts : Resources{ids},
          .writes = run_sums,
          .record = [](const Recording &at) { vulkan::host_barrier(at.commands); },
          .store = [sum](const Recording &at, Measurement &) { sum->sum(at.of_strip()); }};
}

} // namespace pmdsim
