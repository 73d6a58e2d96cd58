#include "engine/light/host/host_sum.h"

#include "engine/light/host/strip_sums.h"
#include "engine/model/instruction_sets.h"
#include "engine/vulkan/commands.h"

#include <algorithm>

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::SumLaws, sum_laws)

namespace pmdsim {

namespace {

constexpr std::size_t most_moments = 32; // of a sample

class SumOnHost {
public:
  SumOnHost(const PassSetup &on, const SourceGroups &groups, const SumScope &scope)
      : buffers_(on.buffers), sums_(on, groups, scope, false),
        sum_laws_(widest_sum_laws(on.options.host_vector_bits)) {}

  void sum(const shader::Strip &strip) const {
    LawSums sums = sums_.of(strip);
    sums.run_moments = buffers_.run_moments.mapped_as<float>();
    if (!sums_.are_listed())
      clear_padding(sums);
    sums_.for_each_part(
        sums, [&](std::uint32_t first, std::uint32_t last) { sum_laws_.sum_rows(sums, first, last); },
        [&](std::uint32_t first, std::uint32_t last) { sum_laws_.sum_blocks(sums, first, last); });
  }

private:
  // The device reads it, too.
  static void clear_padding(const LawSums &sums) {
    const std::uint32_t samples = sums.samples.strip.columns * sums.samples.strip.rows;
    for (std::size_t plane = 0; plane < std::size_t{sums.moments + 1} * sums.run_count; ++plane)
      std::fill_n(sums.run_moments + plane * sums.plane + samples, sums.plane - samples, 0.0f);
  }

  const StripBuffers &buffers_;
  StripSums sums_;
  SumLaws sum_laws_;
};

} // namespace

bool can_sum_on_host(const SourceGroups &groups) {
  return groups.moments <= shader::largest_moments && std::ranges::all_of(groups.diodes, is_known_to_host);
}

bool keeps_few_moments(const SourceGroups &groups) {
  return (groups.moments + 1) * groups.runs.size() <= most_moments;
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
