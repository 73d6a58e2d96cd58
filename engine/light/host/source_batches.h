#pragma once
// The sources of a frame as the host sums them: in batches that are alike but for their places.

#include "engine/light/host/law_sums.h"
#include "engine/light/source_groups.h"
#include "engine/light/sum_model.h"

#include <deque>
#include <map>
#include <span>
#include <vector>

namespace pmdsim {

// Whether the host knows a source's law.
bool is_known_to_host(const shader::GroupSource &source);

class SourceBatches {
public:
  // For groups whose moments belong to a wavenumber; `with_tables`: powers of u may stand for roots.
  SourceBatches(const SourceGroups &groups, const SumModel &model, double wavenumber_rad_m, bool with_tables);
  SourceBatches(const SourceBatches &) = delete;
  SourceBatches &operator=(const SourceBatches &) = delete;

  std::span<const RunOfBatches> runs() const { return runs_; }

private:
  struct Table {
    std::vector<float> values, rises, cells;
    LawTable table;
  };
  struct Batch {
    shader::GroupSource like; // one of its sources
    double along_m;
    std::vector<BatchSource> sources;
    std::vector<std::uint32_t> bits;
  };

  void add_run(const SourceGroups &groups, const SourceRun &run, std::uint32_t first_bit);
  void add_tables(const SourceGroups &groups, double wavenumber_rad_m);
  SourceBatch view_of(const Batch &batch) const;

  bool of_lengths_; // all are cosines of one power, which are lengths' powers then
  double inverse_powers_;
  std::map<std::uint32_t, Table> tables_; // by GroupSource::diagram
  std::deque<std::deque<Batch>> batches_; // of each run
  std::deque<std::vector<SourceBatch>> views_;
  std::deque<std::vector<PowerTable>> power_tables_; // of runs
  std::vector<RunOfBatches> runs_;
};

} // namespace pmdsim
