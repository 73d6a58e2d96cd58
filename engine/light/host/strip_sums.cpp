#include "engine/light/host/strip_sums.h"

#include "engine/vulkan/shader_module.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

constexpr std::uint32_t blocks_at_once = 32;
static_assert(most_visibility_words == bundles_per_host_window);

// Whether powers may stand for roots: where rounding is bounded as if they did, and something is summed so.
bool takes_powers(const PassSetup &on, const SourceGroups &groups, const SumScope &scope,
                  bool bounds_growth) {
  const bool are_summed = !scope.beforehand || scope.tests_facing;
  const bool are_bounded = groups.polynomials.powers > 0 || (groups.near_polynomials && bounds_growth);
  return are_summed && (are_bounded || !on.modulation.keeps_terms);
}

} // namespace

StripSums::StripSums(const PassSetup &on, const SourceGroups &groups, const SumScope &scope,
                     bool bounds_growth)
    : buffers_(on.buffers), samples_(on.buffers, on.scene.planes, on.sensor, scope.depth_records,
                                     vulkan::uses_fp64(on.device, on.options.precision)),
      blocks_(scope.blocks), field_(scope.field),
      lambert_(on.model.backscatter == shader::backscatter_lambert), shadowed_(scope.shadowed),
      moments_(groups.moments), bundles_per_run_(bundles_per_run(groups)), shining_(shining_diodes(groups)),
      batches_(groups, on.model, on.modulation.largest_wavenumber_rad_m(),
               takes_powers(on, groups, scope, bounds_growth)) {}

LawSums StripSums::of(const shader::Strip &strip) const {
  return {.samples = samples_.of(strip),
          .blocks = blocks_ ? reinterpret_cast<const std::uint32_t *>(
                                  blocks_->list->mapped_as<shader::WorkList>() + 1)
                            : nullptr,
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
          .run_moments = nullptr,
          .field = field_ ? &field_->grid : nullptr,
          .beams = field_ ? field_->beams.data() : nullptr};
}

namespace {

// The cells that a stretch of samples meets.
std::uint32_t cells_of(std::uint32_t first, std::uint32_t count, std::uint32_t side) {
  return (first + count + side - 1) / side - first / side;
}

} // namespace

std::uint32_t StripSums::cells_across(const shader::Strip &strip) const {
  return field_ ? cells_of(strip.column, strip.columns, field_->grid.side) : 0;
}

void StripSums::for_each_cell(const shader::Strip &strip, const LoopOverPart &of_cells) const {
  const std::uint32_t count = cells_across(strip) * cells_of(strip.row, strip.rows, field_->grid.side);
  using Range = tbb::blocked_range<std::uint32_t>;
  tbb::parallel_for(Range(0, count), [&](const Range &cells) { of_cells(cells.begin(), cells.end()); });
}

void StripSums::for_each_part(const LawSums &sums, const LoopOverPart &of_rows,
                              const LoopOverPart &of_blocks) const {
  using Range = tbb::blocked_range<std::uint32_t>;
  if (!blocks_)
    return tbb::parallel_for(Range(0, sums.samples.strip.rows),
                             [&](const Range &rows) { of_rows(rows.begin(), rows.end()); });
  tbb::parallel_for(Range(0, blocks_->list->mapped_as<shader::WorkList>()->count, blocks_at_once),
                    [&](const Range &blocks) { of_blocks(blocks.begin(), blocks.end()); });
}

} // namespace pmdsim
