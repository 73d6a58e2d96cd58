#include "engine/light/host/host_sum.h"

#include "engine/light/host/source_batches.h"
#include "engine/model/instruction_sets.h"
#include "engine/sampling/host/host_samples.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/shader_module.h"

#include <algorithm>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::SumLaws, sum_laws)

namespace pmdsim {

namespace {

constexpr std::size_t most_moments = 32; // of a sample

// Whether rounding is bounded as if powers stood for roots.
bool has_bound_of_powers(const SourceGroups &groups) { return groups.polynomials.powers > 0; }

class SumOnHost {
public:
  SumOnHost(const PassSetup &on, const SourceGroups &groups, const SumScope &scope)
      : buffers_(on.buffers), samples_(on.buffers, on.scene.planes, on.sensor, scope.depth_records,
                                       vulkan::uses_fp64(on.device, on.options.precision)),
        blocks_(scope.blocks), lambert_(on.model.backscatter == shader::backscatter_lambert),
        shadowed_(scope.shadowed), moments_(groups.moments), bundles_per_run_(bundles_per_run(groups)),
        shining_(shining_diodes(groups)), batches_(groups, on.model, on.modulation.largest_wavenumber_rad_m(),
                                                   has_bound_of_powers(groups) || !on.modulation.keeps_terms),
        sum_laws_(widest_sum_laws(on.options.host_vector_bits)) {}

  void sum(const shader::Strip &strip) const {
    LawSums sums = sums_of(strip);
    using Range = tbb::blocked_range<std::uint32_t>;
    if (!blocks_) {
      clear_padding(sums);
      return tbb::parallel_for(Range(0, sums.samples.strip.rows), [&](const Range &rows) {
        sum_laws_.sum_rows(sums, rows.begin(), rows.end());
      });
    }
    const auto *list = blocks_->list->mapped_as<shader::WorkList>();
    sums.blocks = reinterpret_cast<const std::uint32_t *>(list + 1);
    tbb::parallel_for(Range(0, list->count, blocks_at_once),
                      [&](const Range &blocks) { sum_laws_.sum_blocks(sums, blocks.begin(), blocks.end()); });
  }

private:
  static constexpr std::uint32_t blocks_at_once = 32;

  // The device reads it, too.
  void clear_padding(const LawSums &sums) const {
    const std::uint32_t samples = sums.samples.strip.columns * sums.samples.strip.rows;
    for (std::size_t plane = 0; plane < (moments_ + 1) * batches_.runs().size(); ++plane)
      std::fill_n(sums.run_moments + plane * sums.plane + samples, sums.plane - samples, 0.0f);
  }

  LawSums sums_of(const shader::Strip &strip) const {
    return {.samples = samples_.of(strip),
            .blocks = nullptr,
            .runs = batches_.runs().data(),
            .run_count = static_cast<std::uint32_t>(batches_.runs().size()),
            .moments = moments_,
            .lambert = lambert_,
            .visibility = shadowed_ ? buffers_.visibility.mapped_as<std::uint32_t>() : nullptr,
            .lit = shadowed_ ? buffers_.lit.mapped_as<std::uint32_t>() : nullptr,
            .visibility_words =
                shadowed_ ? bundles_per_run_ * static_cast<std::uint32_t>(batches_.runs().size()) : 0,
            .shining = shining_,
            .plane = sample_count(strip),
            .run_moments = buffers_.run_moments.mapped_as<float>()};
  }

  const StripBuffers &buffers_;
  HostSamples samples_;
  std::optional<SampleBlocks> blocks_;
  bool lambert_, shadowed_;
  std::uint32_t moments_, bundles_per_run_, shining_;
  SourceBatches batches_;
  SumLaws sum_laws_;
};

} // namespace

bool can_sum_on_host(const SourceGroups &groups) {
  return groups.moments <= shader::largest_moments &&
         (groups.moments + 1) * groups.runs.size() <= most_moments &&
         std::ranges::all_of(groups.diodes, is_known_to_host);
}

Pass host_sum_pass(const PassSetup &on, const SourceGroups &groups, const SumScope &scope) {
  const auto sum = std::make_shared<const SumOnHost>(on, groups, scope);
  return {.name = "accumulate",
          .reads = ids | (scope.shadowed ? visibility_bits | visibility_counts : no_resource) |
                   (scope.blocks ? block_lists : no_resource),
          .writes = run_moments,
          .record = [](const Recording &at) { vulkan::host_barrier(at.commands); },
          .store = [sum](const Recording &at, Measurement &) { sum->sum(at.of_strip()); }};
}

} // namespace pmdsim
