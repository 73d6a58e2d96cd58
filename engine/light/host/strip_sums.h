#pragma once
// The sums over the sources in a strip's depth records, as the host's loops take them.

#include "engine/light/accumulate_pass.h"
#include "engine/light/host/source_batches.h"
#include "engine/sampling/host/host_samples.h"

#include <functional>

namespace pmdsim {

// Over some rows, or some blocks of a list, the last one excluded.
using LoopOverPart = std::function<void(std::uint32_t first, std::uint32_t last)>;

class StripSums {
public:
  // `bounds_growth`: the loops tell by what rounding grows where tables stand for roots.
  StripSums(const PassSetup &on, const SourceGroups &groups, const SumScope &scope, bool bounds_growth);

  // Without a place for its moments.
  LawSums of(const shader::Strip &strip) const;

  // The number of cells of the field over a row of the strip.
  std::uint32_t cells_across(const shader::Strip &strip) const;

  // Calls `of_cells` for parts of the field's cells, row by row of the strip, that threads share out.
  void for_each_cell(const shader::Strip &strip, const LoopOverPart &of_cells) const;

  // Calls one of both for parts of the strip that threads share out: `of_blocks` where blocks are listed.
  void for_each_part(const LawSums &sums, const LoopOverPart &of_rows, const LoopOverPart &of_blocks) const;

  bool are_listed() const { return blocks_.has_value(); }
  bool has_field() const { return field_.has_value(); }

private:
  const StripBuffers &buffers_;
  HostSamples samples_;
  std::optional<SampleBlocks> blocks_;
  std::optional<InterpolatedField> field_;
  bool lambert_, shadowed_;
  std::uint32_t moments_, bundles_per_run_, shining_;
  SourceBatches batches_;
};

} // namespace pmdsim
