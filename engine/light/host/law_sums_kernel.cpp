// The host's sums over the sources, a lane a sample. Compiled once for each instruction set,
// PMDSIM_INSTRUCTION_SET its name; see engine/CMakeLists.txt. It does what add_block and find_moments of
// shaders/light/moments.glsl do, with lengths in units of the sample's distance from the reference point.
#include "engine/light/host/laws.h"
#include "engine/light/host/vector_samples.h"
#include "shaders/light/source_windows.h"

#include <algorithm>
#include <cmath>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

// From the run's reference point.
struct RunView {
  double from_reference_m[3][lanes];
  double height_m[lanes]; // of the reference point over the surface
  Floats rho_m, inverse_m;
};

// In a batch's frame, from the run's reference point; heights, normals and detours in units of rho.
struct BatchView {
  Floats x_m, y_m, along_m;          // the latter from the batch's plane
  Floats normal_x, normal_y, height; // the latter of the reference point's foot in the plane over the surface
  Floats twice_x, twice_y, detour;   // of u: by the source's place, and what all sources have
  Floats inverse2_m2;                // what its square distance from the reference point has to do with u
  Floats along;                      // its length's power is W's, where W is one of lengths
};

RunView view_from(const VectorSamples &samples, const RunOfBatches &run) {
  RunView view;
  alignas(vector_bytes) float rho[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    double rho2 = 0.0, height = -samples.offset_m[lane];
    for (int k = 0; k < 3; ++k) {
      const double away = samples.point_m[k][lane] - run.reference_m[k];
      view.from_reference_m[k][lane] = away;
      rho2 += away * away;
      height += samples.normal[k][lane] * run.reference_m[k];
    }
    view.height_m[lane] = height;
    rho[lane] = static_cast<float>(std::sqrt(rho2));
  }
  view.rho_m = load<Floats>(rho);
  view.inverse_m = 1.0f / view.rho_m;
  return view;
}

BatchView view_from(const VectorSamples &samples, const RunView &run, const SourceBatch &batch) {
  alignas(vector_bytes) float place[3][lanes], normal[2][lanes], height[lanes], detour[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    double in_frame_m[3] = {}, turned[3] = {};
    for (int row = 0; row < 3; ++row)
      for (int k = 0; k < 3; ++k) {
        in_frame_m[row] += batch.rotation[row][k] * run.from_reference_m[k][lane];
        turned[row] += batch.rotation[row][k] * samples.normal[k][lane];
      }
    place[0][lane] = static_cast<float>(in_frame_m[0]);
    place[1][lane] = static_cast<float>(in_frame_m[1]);
    place[2][lane] = static_cast<float>(in_frame_m[2] - batch.along_m);
    normal[0][lane] = static_cast<float>(turned[0]);
    normal[1][lane] = static_cast<float>(turned[1]);
    height[lane] = static_cast<float>(run.height_m[lane] + batch.along_m * turned[2]);
    detour[lane] = static_cast<float>(-2.0 * batch.along_m * in_frame_m[2]);
  }
  const Floats x = load<Floats>(place[0]), y = load<Floats>(place[1]), along = load<Floats>(place[2]),
               inverse = run.inverse_m, inverse2 = inverse * inverse;
  return {x,
          y,
          along,
          load<Floats>(normal[0]) * inverse,
          load<Floats>(normal[1]) * inverse,
          load<Floats>(height) * inverse,
          -2.0f * x * inverse2,
          -2.0f * y * inverse2,
          load<Floats>(detour) * inverse2,
          inverse2,
          larger(along, all(0.0f)) * inverse};
}

// Which sources reach the samples, as visibility bits.
struct Reach {
  Ints words[shader::bundles_per_window];
  std::uint32_t any[shader::bundles_per_window]; // of the samples

  Ints of(std::uint32_t bit) const {
    return words[bit / 32] & all(static_cast<std::int32_t>(1u << bit % 32));
  }
  bool none_of(std::uint32_t bit) const { return (any[bit / 32] >> bit % 32 & 1u) == 0u; }
};

void find_reach(const LawSums &of, const VectorSamples &samples, Reach &reach) {
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

// A source's part of the first sum, and what its part of each following one is over that of the one before.
struct Parts {
  Floats first, factor;
};

// Of sums of W u^i.
struct ByPowers {
  Parts operator()(const Floats &weight, const Floats &u) const { return {weight, u}; }
};

// Of moments: w = W (1 + u)^(-p / 2), e = sqrt(1 + u) - 1.
struct ByRoots {
  std::uint32_t inverse_powers;

  Parts operator()(Floats weight, const Floats &u) const {
    const Floats stretch2 = larger(1.0f + u, all(tiny)), inverse = inverse_root(stretch2);
    for (std::uint32_t i = 0; i < inverse_powers; ++i)
      weight *= inverse;
    return {weight, u / (1.0f + stretch2 * inverse)};
  }
};

// Block by block, so that rounding is no worse than on the device.
template <std::size_t sums, bool lambert, bool shadowed, class Law, class By>
void add_sources(const SourceBatch &batch, const BatchView &at, const Law &law, const By &by,
                 const Reach &reach, Floats *total) {
  const Floats none = all(0.0f);
  for (std::uint32_t first = 0; first < batch.count; first += shader::diodes_per_block) {
    Floats part[sums] = {};
    const std::uint32_t last = std::min(batch.count, first + shader::diodes_per_block);
    for (std::uint32_t i = first; i < last; ++i) {
      if (shadowed && reach.none_of(batch.bits[i]))
        continue;
      const BatchSource source = batch.sources[i];
      const Floats height = at.height + at.normal_x * source.x_m + at.normal_y * source.y_m;
      const Floats facing = lambert ? larger(height, none) : height > 0.0f ? all(1.0f) : none;
      Floats weight = source.intensity * facing * law(at.x_m - source.x_m, at.y_m - source.y_m);
      if (shadowed)
        weight = reach.of(batch.bits[i]) != 0 ? weight : none;
      auto [term, factor] = by(weight, at.inverse2_m2 * source.square_m2 + at.twice_x * source.x_m +
                                           at.twice_y * source.y_m + at.detour);
      part[0] += term;
      // Fused in each of the sums, so that a sample's do not depend on how many its neighbours need.
      for (std::size_t k = 1; k < sums; ++k) {
        part[k] = multiply_add(term, factor, part[k]);
        term *= factor;
      }
    }
    for (std::size_t k = 0; k < sums; ++k)
      total[k] += part[k];
  }
}

float least(const Floats &v) {
  float result = v[0];
  for (int i = 1; i < lanes; ++i)
    result = std::min(result, v[i]);
  return result;
}
float most(const Floats &v) { return -least(-v); }

// Of the angles between a batch's axis and the ways from its sources to the samples.
struct Tangents {
  float least, most;
};

Tangents tangents_of(const SourceBatch &batch, const BatchView &at) {
  if (!(least(at.along_m) > 0.0f))
    return {0.0f, 1e9f};
  const Floats inverse = 1.0f / at.along_m;
  const Floats off_axis = root(larger(at.x_m * at.x_m + at.y_m * at.y_m, all(tiny)));
  constexpr float slack = 1e-5f;
  return {least(larger(off_axis - batch.radius_m, all(0.0f)) * inverse) * (1.0f - slack),
          most((off_axis + batch.radius_m) * inverse) * (1.0f + slack)};
}

// The first step of a stretch of NearAngles::width that holds all angles, if there is one.
bool find_stretch(const LawTable &table, const Tangents &tangents, std::int32_t &first) {
  const auto step_of = [&](float tangent) {
    return std::atan(tangent) * table.steps_per_rad - table.first_step;
  };
  const float low = std::floor(step_of(tangents.least) - 1e-3f), high = step_of(tangents.most) + 1e-3f;
  first = static_cast<std::int32_t>(std::max(low, -1.0f));
  return low >= -1.0f && high < static_cast<float>(std::min(first + 2 * lanes, table.steps + 1));
}

template <class Add>
void add_by_table(const LawTable &table, const SourceBatch &batch, const BatchView &at, const Add &add) {
  const Tangents tangents = tangents_of(batch, at);
  if (table.cells)
    return tangents.most <= Within45::largest ? add(AroundAxis<NearAxis>(table, at.along_m))
                                              : add(AroundAxis<ToAxis>(table, at.along_m));
  std::int32_t first = 0;
  if (tangents.most > Within45::largest || !find_stretch(table, tangents, first))
    add(AnyAngle(table, at.along_m));
  else if (tangents.most <= Within16::largest)
    add(NearAngles<Within16>(table, first, 1.0f / at.along_m));
  else if (tangents.most <= Within30::largest)
    add(NearAngles<Within30>(table, first, 1.0f / at.along_m));
  else
    add(NearAngles<Within45>(table, first, 1.0f / at.along_m));
}

// Sources that have one J or one length's power in common.
template <std::size_t sums, bool lambert, bool shadowed, class By>
void add_alike(const SourceBatch &batch, const BatchView &at, const By &by, const Reach &reach,
               Floats *total) {
  Floats own[sums] = {}, shared = all(1.0f);
  for (std::uint32_t i = 0; i < batch.power; ++i)
    shared *= at.along;
  add_sources<sums, lambert, shadowed>(batch, at, SharedByAll(), by, reach, own);
  for (std::size_t k = 0; k < sums; ++k)
    total[k] += shared * own[k];
}

template <std::size_t sums, bool lambert, bool shadowed, class By>
void add_batch(const SourceBatch &batch, const BatchView &at, const By &by, const Reach &reach,
               Floats *total) {
  constexpr std::size_t of_laws = std::max<std::size_t>(sums, 6);
  const auto add = [&](const auto &law) {
    Floats own[of_laws] = {};
    add_sources<of_laws, lambert, shadowed>(batch, at, law, by, reach, own);
    for (std::size_t k = 0; k < sums; ++k)
      total[k] += own[k];
  };
  if (batch.table)
    add_by_table(*batch.table, batch, at, add);
  else if (batch.of_lengths || batch.power == 0)
    add_alike<sums, lambert, shadowed>(batch, at, by, reach, total);
  else
    add(WholePower(batch.power, at.along_m));
}

template <class By>
using AddBatch = void (*)(const SourceBatch &, const BatchView &, const By &, const Reach &, Floats *);

template <std::size_t sums, class By>
AddBatch<By> add_batch_of(bool lambert, bool shadowed) {
  return lambert    ? shadowed ? add_batch<sums, true, true, By> : add_batch<sums, true, false, By>
            : shadowed ? add_batch<sums, false, true, By>
                    : add_batch<sums, false, false, By>;
}

template <class By>
AddBatch<By> add_batch_of(std::uint32_t sums, bool lambert, bool shadowed) {
  return sums <= 4   ? add_batch_of<4, By>(lambert, shadowed)
         : sums <= 6 ? add_batch_of<6, By>(lambert, shadowed)
         : sums <= 8 ? add_batch_of<8, By>(lambert, shadowed)
                     : add_batch_of<most_host_sums, By>(lambert, shadowed);
}

// |u| of a run's sources, at most: of one batch by how the sample lies to its plane, else by its distance.
Floats largest_u(const VectorSamples &samples, const RunOfBatches &run, const RunView &view) {
  constexpr float slack = 1.00001f;
  if (run.count != 1) {
    const Floats t = run.radius_m * view.inverse_m;
    return slack * t * (t + 2.0f);
  }
  const SourceBatch &batch = run.batches[0];
  const BatchView at = view_from(samples, view, batch);
  const float along_m = std::abs(static_cast<float>(batch.along_m)), radius_m = batch.radius_m;
  const Floats across = root(larger(at.x_m * at.x_m + at.y_m * at.y_m, all(tiny)));
  const Floats product = across * radius_m + (absolute(at.along_m) + along_m) * along_m;
  return slack * at.inverse2_m2 * (radius_m * radius_m + along_m * along_m + 2.0f * product);
}

// Of each sample the first of the run's tables that reaches so far, or how many there are.
Ints tables_of(const VectorSamples &samples, const RunOfBatches &run, const RunView &view) {
  Ints table = all(0);
  if (run.table_count == 0)
    return table;
  const Floats largest = largest_u(samples, run, view);
  for (std::uint32_t i = 0; i < run.table_count; ++i)
    table -= largest > run.tables[i].largest_u;
  return table;
}

// Moments from sums of powers, of the samples that a table is for, and behind them the first sum.
void find_moments(const PowerTable &table, const Ints &takes, std::uint32_t moments, const Floats *sums,
                  Floats *moment) {
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

  // The moments of a run, m^-2 m^k.
  void sum(const RunOfBatches &run, Floats *moment) const {
    const RunView view = view_from(samples_, run);
    const Ints table = tables_of(samples_, run, view);
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

// Where a law depends on a vector's other samples, these are the same however strips and threads part them.
void sum_rows(const LawSums &of, std::uint32_t first, std::uint32_t last) {
  const auto sum = [&](VectorSamples &samples) { sum_vector(of, samples); };
  Gathering gathering(sum);
  const std::uint32_t columns = of.samples.strip.columns;
  for (std::uint32_t row = first; row < last; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column)
      gathering.add(row * columns + column);
    gathering.end();
  }
}

void sum_blocks(const LawSums &of, std::uint32_t first, std::uint32_t last) {
  const auto sum = [&](VectorSamples &samples) { sum_vector(of, samples); };
  Gathering gathering(sum);
  for (std::uint32_t i = first; i < last; ++i) {
    const std::uint32_t sample = of.blocks[i] / shader::block_samples;
    for (std::uint32_t k = 0; k <= of.blocks[i] % shader::block_samples; ++k)
      gathering.add(sample + k);
  }
  gathering.end();
}

} // namespace

extern const SumLaws sum_laws;
const SumLaws sum_laws{sum_rows, sum_blocks};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
