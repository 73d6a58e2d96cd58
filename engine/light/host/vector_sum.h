#pragma once
// The moments of the samples of a vector, source by source: what add_block and find_moments of
// shaders/light/moments.glsl do, with lengths in units of the sample's distance from the reference point.
#include "engine/light/host/batch_sums.h"

#include <algorithm>
#include <cstdint>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

inline void find_reach(const LawSums &of, const VectorSamples &samples, Reach &reach) {
  const Ints number = load<Ints>(samples.number), sees = load<Ints>(samples.sees);
  for (std::uint32_t word = 0; word < of.visibility_words; ++word) {
    const auto *plane = reinterpret_cast<const std::int32_t *>(of.visibility) + std::size_t{word} * of.plane;
    const Ints words = gathered(plane, number) & -sees;
    reach.words[word] = words;
    std::uint32_t any = 0;
    for (int lane = 0; lane < lanes; ++lane)
      any |= static_cast<std::uint32_t>(words[lane]);
    reach.any[word] = any;
  }
}

// For each sample, the first of the run's tables that reaches so far, or the number of tables.
inline Ints tables_of(const RunOfBatches &run, const Floats &largest_u) {
  Ints table = all(0);
  for (std::uint32_t i = 0; i < run.table_count; ++i)
    table -= largest_u > run.tables[i].largest_u;
  return table;
}

// The factor by which the terms of a table's weights, all taken as positive, may exceed their first sum; 1
// where roots are drawn.
inline Floats growth_of(const RunOfBatches &run, const Ints &table, const Floats &largest_u) {
  Floats growth = all(1.0f);
  for (std::uint32_t t = 0; t < run.table_count; ++t) {
    const Ints takes = table == static_cast<std::int32_t>(t);
    if (bits_of(takes) == 0)
      continue;
    Floats sum = all(0.0f);
    for (std::uint32_t i = run.tables[t].powers; i-- > 0;)
      sum = sum * largest_u + std::abs(run.tables[t].of_moments[0][i]);
    growth = takes != 0 ? sum : growth;
  }
  return growth;
}

// Moments from sums of powers for the samples that a table is for, and behind them the first sum.
inline void find_moments(const PowerTable &table, const Ints &takes, std::uint32_t moments,
                         const Floats *sums, Floats *moment) {
  for (std::uint32_t k = 0; k < moments; ++k) {
    Floats sum = all(0.0f);
    for (std::uint32_t down = 0; down < table.powers; ++down) {
      const std::uint32_t i = table.powers - 1 - down;
      sum += table.of_moments[k][i] * sums[i];
    }
    moment[k] = takes != 0 ? sum : moment[k];
  }
  moment[moments] = takes != 0 ? sums[0] : moment[moments];
}

class VectorSum {
public:
  VectorSum(const LawSums &of, const VectorSamples &samples) : of_(of), samples_(samples) {
    shadowed_ = is_shadowed();
    if (shadowed_)
      find_reach(of, samples, reach_);
  }

  // The moments of a run, m^-2 m^k, and, where it is asked for, what rounding grows by.
  void sum(const RunOfBatches &run, Floats *moment, Floats *growth = nullptr) const {
    const RunView view = view_from(samples_, run);
    const Floats u = run.table_count > 0 ? largest_u(samples_, run, view) : all(0.0f);
    const Ints table = tables_of(run, u);
    if (growth)
      *growth = growth_of(run, table, u);
    sum_powers(run, view, table, moment);
    const auto beyond = static_cast<std::int32_t>(run.table_count);
    if (bits_of(table == beyond) != 0) {
      Floats sums[most_host_sums] = {};
      add(run, view, of_.moments, ByRoots{run.inverse_powers}, sums);
      for (std::uint32_t k = 0; k < of_.moments; ++k)
        moment[k] = table == beyond ? sums[k] : moment[k];
      moment[of_.moments] = table == beyond ? sums[0] : moment[of_.moments];
    }
    moment[of_.moments] *= view.inverse_m * view.inverse_m;
    Floats scale = view.inverse_m * view.inverse_m;
    for (std::uint32_t k = 0; k < of_.moments; ++k, scale *= view.rho_m)
      moment[k] *= scale;
  }

private:
  bool is_shadowed() const {
    bool shadowed = false;
    for (int lane = 0; lane < lanes && of_.visibility; ++lane)
      shadowed = shadowed || (samples_.sees[lane] != 0 && of_.lit[samples_.number[lane]] != of_.shining);
    return shadowed;
  }

  void sum_powers(const RunOfBatches &run, const RunView &view, const Ints &table, Floats *moment) const {
    std::uint32_t powers = 0;
    for (std::uint32_t i = 0; i < run.table_count; ++i)
      if (bits_of(table == static_cast<std::int32_t>(i)) != 0)
        powers = run.tables[i].powers;
    if (powers == 0)
      return;
    Floats sums[most_host_sums] = {};
    add(run, view, powers, ByPowers(), sums);
    for (std::uint32_t i = 0; i < run.table_count && run.tables[i].powers <= powers; ++i)
      find_moments(run.tables[i], table == static_cast<std::int32_t>(i), of_.moments, sums, moment);
  }

  template <class By>
  void add(const RunOfBatches &run, const RunView &view, std::uint32_t sums, const By &by,
           Floats *total) const {
    const AddBatch<By> add_batch = add_batch_of<By>(sums, of_.lambert, shadowed_);
    // Small batches together, block by block, as the sources of a large one.
    Floats block[most_host_sums] = {};
    std::uint32_t in_block = 0;
    const auto end_block = [&] {
      for (std::uint32_t k = 0; k < sums; ++k) {
        total[k] += block[k];
        block[k] = all(0.0f);
      }
      in_block = 0;
    };
    for (std::uint32_t i = 0; i < run.count; ++i) {
      const SourceBatch &batch = run.batches[i];
      const bool is_large = batch.count >= shader::diodes_per_block;
      add_batch(batch, view_from(samples_, view, batch), by, reach_, is_large ? total : block);
      in_block += is_large ? 0 : batch.count;
      if (in_block >= shader::diodes_per_block)
        end_block();
    }
    end_block();
  }

  const LawSums &of_;
  const VectorSamples &samples_;
  bool shadowed_;
  Reach reach_;
};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
