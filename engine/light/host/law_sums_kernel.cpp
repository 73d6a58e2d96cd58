// The host's sums over the sources, a lane a sample. Compiled once for each instruction set,
// PMDSIM_INSTRUCTION_SET its name; see engine/CMakeLists.txt. It does what add_block of
// shaders/light/moments.glsl does.
#include "engine/light/host/laws.h"
#include "engine/sampling/host/sample_points.h"

#include <algorithm>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

// Neighbouring samples of a row, camera frame.
struct Samples {
  double point_m[3][lanes];
  double normal[3][lanes], offset_m[lanes]; // of the surface's plane, as in TrianglePlane
  std::int32_t sees[lanes];
};

// In a batch's frame, from the run's reference point.
struct BatchView {
  Floats x_m, y_m, along_m; // the latter from the batch's plane
  Floats normal_x, normal_y;
  Floats height_m;  // of the reference point's foot in the plane over the surface
  Floats detour_m2; // of q what all sources have
};

void find_surface(const shader::TrianglePlane &plane, int lane, Samples &samples) {
  const auto exact = [&](int k) {
    return static_cast<double>(plane.plane_hi[k]) + static_cast<double>(plane.plane_lo[k]);
  };
  for (int k = 0; k < 3; ++k)
    samples.normal[k][lane] = exact(k);
  samples.offset_m[lane] = exact(3);
}

// Beyond the last sample it stands for all.
Samples samples_at(const SampleSource &of, std::uint32_t first, std::uint32_t last) {
  Samples samples;
  Place place{first % of.strip.columns, first / of.strip.columns, 0, 0, first};
  for (int lane = 0; lane < lanes; ++lane) {
    double point[3];
    std::uint32_t shape;
    find_point(of, place, point, shape);
    for (int k = 0; k < 3; ++k)
      samples.point_m[k][lane] = point[k];
    samples.sees[lane] = point[2] != 0.0;
    find_surface(of.planes[samples.sees[lane] != 0 ? shape : 0], lane, samples);
    if (place.index + 1 == last)
      continue;
    ++place.index;
    if (++place.column == of.strip.columns) {
      place.column = 0;
      ++place.row;
    }
  }
  return samples;
}

// What sees nothing takes another one's place, so that all are near each other.
void fill_gaps(Samples &samples, int seen) {
  for (int lane = 0; lane < lanes; ++lane)
    if (samples.sees[lane] == 0)
      for (int k = 0; k < 3; ++k)
        samples.point_m[k][lane] = samples.point_m[k][seen];
}

BatchView view_from(const Samples &samples, const RunOfBatches &run, const SourceBatch &batch) {
  alignas(vector_bytes) float place[3][lanes], normal[2][lanes], height[lanes], detour[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    double height_m = -samples.offset_m[lane], in_frame_m[3], turned[3];
    for (int row = 0; row < 3; ++row) {
      in_frame_m[row] = turned[row] = 0.0;
      for (int k = 0; k < 3; ++k) {
        in_frame_m[row] += batch.rotation[row][k] * (samples.point_m[k][lane] - run.reference_m[k]);
        turned[row] += batch.rotation[row][k] * samples.normal[k][lane];
      }
      height_m += samples.normal[row][lane] * run.reference_m[row];
    }
    place[0][lane] = static_cast<float>(in_frame_m[0]);
    place[1][lane] = static_cast<float>(in_frame_m[1]);
    place[2][lane] = static_cast<float>(in_frame_m[2] - batch.along_m);
    normal[0][lane] = static_cast<float>(turned[0]);
    normal[1][lane] = static_cast<float>(turned[1]);
    height[lane] = static_cast<float>(height_m + batch.along_m * turned[2]);
    detour[lane] = static_cast<float>(-2.0 * batch.along_m * in_frame_m[2]);
  }
  return {load<Floats>(place[0]),  load<Floats>(place[1]), load<Floats>(place[2]), load<Floats>(normal[0]),
          load<Floats>(normal[1]), load<Floats>(height),   load<Floats>(detour)};
}

// Which sources reach the samples, as visibility bits; where all do there are none.
struct Reach {
  const std::uint32_t *words;
  std::uint32_t plane;

  Ints of(std::uint32_t bit) const {
    return load<Ints>(words + std::size_t{bit / 32} * plane) & all(static_cast<std::int32_t>(1u << bit % 32));
  }
};

// Block by block, so that rounding is no worse than on the device.
template <std::size_t powers, bool lambert, bool shadowed, class Law>
void add_sources(const SourceBatch &batch, const BatchView &at, const Law &law, const Reach &reach,
                 Floats *total) {
  const Floats twice_x = -2.0f * at.x_m, twice_y = -2.0f * at.y_m, none = all(0.0f);
  for (std::uint32_t first = 0; first < batch.count; first += shader::diodes_per_block) {
    Floats part[powers] = {};
    const std::uint32_t last = std::min(batch.count, first + shader::diodes_per_block);
    for (std::uint32_t i = first; i < last; ++i) {
      const BatchSource source = batch.sources[i];
      const Floats height = at.height_m + at.normal_x * source.x_m + at.normal_y * source.y_m;
      const Floats facing = lambert ? larger(height, none) : height > 0.0f ? all(1.0f) : none;
      Floats term = source.intensity * facing * law(at.x_m - source.x_m, at.y_m - source.y_m);
      if (shadowed)
        term = reach.of(batch.bits[i]) != 0 ? term : none;
      const Floats q = source.square_m2 + twice_x * source.x_m + twice_y * source.y_m + at.detour_m2;
      part[0] += term;
      for (std::size_t k = 1; k < powers; ++k) {
        term *= q;
        part[k] += term;
      }
    }
    for (std::size_t k = 0; k < powers; ++k)
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

template <std::size_t powers, bool lambert, bool shadowed>
void add_batch(const SourceBatch &batch, const BatchView &at, const Reach &reach, Floats *total) {
  const auto add = [&](const auto &law) {
    add_sources<powers, lambert, shadowed>(batch, at, law, reach, total);
  };
  if (!batch.table)
    return add(WholePower(batch.power, at.along_m));
  if (batch.table->cells)
    return add(AroundAxis(*batch.table, at.along_m));
  const Tangents tangents = tangents_of(batch, at);
  std::int32_t first = 0;
  if (tangents.most > Within45::largest || !find_stretch(*batch.table, tangents, first))
    add(AnyAngle(*batch.table, at.along_m));
  else if (tangents.most <= Within16::largest)
    add(NearAngles<Within16>(*batch.table, first, 1.0f / at.along_m));
  else if (tangents.most <= Within30::largest)
    add(NearAngles<Within30>(*batch.table, first, 1.0f / at.along_m));
  else
    add(NearAngles<Within45>(*batch.table, first, 1.0f / at.along_m));
}

using AddBatch = void (*)(const SourceBatch &, const BatchView &, const Reach &, Floats *);

template <std::size_t powers>
AddBatch add_batch_of(bool lambert, bool shadowed) {
  return lambert    ? shadowed ? add_batch<powers, true, true> : add_batch<powers, true, false>
            : shadowed ? add_batch<powers, false, true>
                    : add_batch<powers, false, false>;
}

AddBatch add_batch_of(std::uint32_t powers, bool lambert, bool shadowed) {
  return powers <= 5   ? add_batch_of<5>(lambert, shadowed)
         : powers <= 8 ? add_batch_of<8>(lambert, shadowed)
                       : add_batch_of<most_host_powers>(lambert, shadowed);
}

void store_sums(const LawSums &of, const Samples &samples, std::uint32_t first, std::uint32_t run,
                const Floats *total) {
  const Ints sees = load<Ints>(samples.sees);
  for (std::uint32_t k = 0; k < of.powers; ++k)
    store(of.sums + (std::size_t{run} * of.powers + k) * of.plane + first, sees != 0 ? total[k] : all(0.0f));
}

void sum_samples(const LawSums &of, std::uint32_t first, std::uint32_t last) {
  for (; first < last; first += lanes) {
    Samples samples = samples_at(of.samples, first, last);
    const int seen = static_cast<int>(std::find(samples.sees, samples.sees + lanes, 1) - samples.sees);
    const bool sees = seen < lanes;
    bool shadowed = false;
    if (sees) {
      fill_gaps(samples, seen);
      for (int lane = 0; lane < lanes && of.visibility; ++lane)
        shadowed = shadowed ||
                   (samples.sees[lane] && of.lit[first + static_cast<std::uint32_t>(lane)] != of.shining);
    }
    const Reach reach{shadowed ? of.visibility + first : nullptr, of.plane};
    const AddBatch add = add_batch_of(of.powers, of.lambert, shadowed);
    for (std::uint32_t run = 0; run < of.run_count; ++run) {
      Floats total[most_host_powers] = {};
      if (sees) {
        const RunOfBatches &batches = of.runs[run];
        for (std::uint32_t i = 0; i < batches.count; ++i)
          add(batches.batches[i], view_from(samples, batches, batches.batches[i]), reach, total);
      }
      store_sums(of, samples, first, run, total);
    }
  }
}

} // namespace

extern const SumSamples sum_laws;
const SumSamples sum_laws = sum_samples;

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
