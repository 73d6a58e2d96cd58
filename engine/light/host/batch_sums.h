#pragma once
// The sums over a batch's sources, a lane a sample: a template for each number of sums and each backscatter.
#include "engine/light/host/batch_view.h"
#include "shaders/light/source_windows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// Which sources reach the samples, as visibility bits.
struct Reach {
  Ints words[most_visibility_words];
  std::uint32_t any[most_visibility_words]; // those of all samples, by or

  Ints of(std::uint32_t bit) const {
    return words[bit / 32] & all(static_cast<std::int32_t>(1u << bit % 32));
  }
  bool none_of(std::uint32_t bit) const { return (any[bit / 32] >> bit % 32 & 1u) == 0u; }
};

// A source's part of the first sum, and what its part of each following one is over that of the one before.
struct Parts {
  Floats first, factor;
};

// Terms of sums of W u^i.
struct ByPowers {
  Parts operator()(const Floats &weight, const Floats &u) const { return {weight, u}; }
};

// Terms of moments: w = W (1 + u)^(-p / 2), e = sqrt(1 + u) - 1.
struct ByRoots {
  Exponent inverse_powers;

  Parts operator()(Floats weight, const Floats &u) const {
    const Floats stretch2 = larger(1.0f + u, all(tiny)), inverse = inverse_root(stretch2);
    weight *= whole_power(inverse, inverse_powers.whole);
    if (inverse_powers.rest > 0.0f)
      weight *= exp_of(-0.5f * inverse_powers.rest * log_of(stretch2, -u));
    return {weight, u / (1.0f + stretch2 * inverse)};
  }
};

// The sum goes block by block, so that its rounding is no worse than on the device.
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

// Limits of the angles between a batch's axis and the ways from its sources to the samples.
struct Tangents {
  float least, most;
};

inline Tangents tangents_of(const SourceBatch &batch, const BatchView &at) {
  if (!(least_of(at.along_m) > 0.0f))
    return {0.0f, 1e9f};
  const Floats inverse = 1.0f / at.along_m;
  const Floats off_axis = root(larger(at.x_m * at.x_m + at.y_m * at.y_m, all(tiny)));
  constexpr float slack = 1e-5f;
  return {least_of(larger(off_axis - batch.radius_m, all(0.0f)) * inverse) * (1.0f - slack),
          most_of((off_axis + batch.radius_m) * inverse) * (1.0f + slack)};
}

// The first step of a stretch of NearAngles::width that holds all angles, if there is one.
inline bool find_stretch(const LawTable &table, const Tangents &tangents, std::int32_t &first) {
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
  Floats own[sums] = {};
  const Floats shared =
      whole_power(at.along, batch.power.whole) * fraction_of_power(at.along, batch.power.rest);
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
  else if (batch.of_lengths || (batch.power.whole == 0 && batch.power.rest == 0.0f))
    add_alike<sums, lambert, shadowed>(batch, at, by, reach, total);
  else if (batch.is_multiplied)
    add(WholePower(batch.power.whole, at.along_m));
  else
    add(RealPower(static_cast<float>(batch.power.whole) + batch.power.rest, at.along_m));
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

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
