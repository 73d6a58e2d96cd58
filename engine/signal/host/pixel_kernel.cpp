// The host's way from depth records to channels, a lane a pixel. Compiled once for each instruction set,
// PMDSIM_INSTRUCTION_SET its name; see engine/CMakeLists.txt. It does what shaders/frame/direct_pixels.comp
// does.
#include "engine/light/host/incident_field.h"
#include "engine/light/host/point_sums.h"
#include "engine/light/host/vector_sum.h"
#include "engine/signal/host/pixel_claims.h"
#include "engine/signal/host/pixel_loops.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

constexpr double two_pi = 6.283185307179586;

double of_pair(const shader::vec2 &pair) { return static_cast<double>(pair.x) + static_cast<double>(pair.y); }

// The sums over the sources at a vector's samples.
struct Light {
  Floats moment[most_host_sums]; // as many as there are
  Floats weights;                // their sum
  Floats growth = all(1.0f);     // of rounding, where tables stand for roots
  Ints by_field{};               // samples whose sums are interpolated
};

void sum_beforehand(const RunForm &form, const PointView &view, Light &light) {
  Floats total[most_host_sums];
  sum_beforehand(form, view, total);
  find_moments(form, view, total, light.moment, light.weights);
}

// A vector's samples as their sums take them: what they have in common is found once, where it is needed.
class VectorSources {
public:
  // `field`: nullptr where each sample has sums of its own.
  VectorSources(const PixelWork &of, VectorSamples &samples, IncidentField *field)
      : of_(of), samples_(samples), field_(field) {}

  void sum(std::uint32_t run, const PointView &view, Light &light) {
    const Ints takes = field_ ? takes_field(of_.forms[run], view) : Ints{};
    const Ints others = (load<Ints>(samples_.sees) != 0) & ~takes;
    light.by_field = takes;
    std::ranges::fill(light.moment, Floats{});
    if (bits_of(others) != 0)
      sum_at_samples(run, light);
    if (field_ && bits_of(takes) != 0) {
      field_->find(run, samples_, view, takes, light.moment, light.growth);
      light.weights = light.moment[of_.forms[run].moments];
    }
  }

private:
  // The samples that all sources reach and that face all of them well.
  Ints takes_field(const RunForm &form, const PointView &view) const {
    const float height = form.lambert ? static_cast<float>(field_height) : 1.001f;
    const Ints takes =
        (load<Ints>(samples_.sees) != 0) & (view.height > height * form.run->radius_m + 1e-6f * view.rho);
    return of_.sums.visibility ? takes & (gathered(reinterpret_cast<const std::int32_t *>(of_.sums.lit),
                                                   load<Ints>(samples_.number)) ==
                                          static_cast<std::int32_t>(of_.sums.shining))
                               : takes;
  }

  void sum_at_samples(std::uint32_t run, Light &light) {
    if (!sum_) {
      find_surfaces(of_.sums.samples, samples_);
      sum_.emplace(of_.sums, samples_);
    }
    const RunForm &form = of_.forms[run];
    const bool asks_growth = of_.holds && form.powers == 0;
    sum_->sum(of_.sums.runs[run], light.moment, asks_growth ? &light.growth : nullptr);
    light.weights = light.moment[form.moments];
  }

  const PixelWork &of_;
  VectorSamples &samples_;
  IncidentField *field_;
  std::optional<VectorSum> sum_;
};

void sum_light(const PixelWork &of, std::uint32_t run, const VectorSamples &samples, const PointView &view,
               VectorSources &sources, Light &light) {
  const RunForm &form = of.forms[run];
  if (!form.beforehand)
    return sources.sum(run, view, light);
  const Ints sees = load<Ints>(samples.sees) != 0,
             faces = view.height > 1.001f * form.run->radius_m + 1e-6f * view.rho; // all sources
  const Ints apart = form.tests_facing ? sees & ~faces : Ints{};
  if (bits_of(apart) == 0)
    return sum_beforehand(form, view, light);
  sources.sum(run, view, light);
  if (bits_of(sees & faces) == 0)
    return;
  Light facing;
  sum_beforehand(form, view, facing);
  for (std::uint32_t k = 0; k < form.moments; ++k)
    light.moment[k] = apart != 0 ? light.moment[k] : facing.moment[k];
  light.weights = apart != 0 ? light.weights : facing.weights;
}

// sum_k (j kappa)^k / k! * moment[k], by Horner's rule.
Complex return_of(const Light &light, std::uint32_t moments, float kappa) {
  Complex z{};
  for (std::uint32_t k = moments; k-- > 0;) {
    const float factor = kappa / static_cast<float>(k + 1);
    z = {light.moment[k] - z.im * factor, z.re * factor};
  }
  return z;
}

// Relative to twice the sample's own range.
Complex tone_return(const RunForm &form, const Light &light, const PointView &view,
                    const shader::Tone &tone) {
  Wide turns = view.detour * of_pair(tone.turns_per_m);
  if (form.phased)
    turns = turns + of_pair(form.run->phase_turns) * static_cast<double>(tone.harmonic);
  return return_of(light, form.moments, tone.wavenumber) * unit_phasor(turn_fraction(turns));
}

// Of two values a pixel, beside each other: neighbouring pixels at once. The compiler would call it, and hand
// over the vectors through memory, which costs an eighth of the pass.
[[gnu::always_inline]] inline void store_pairs(float *pairs, const VectorSamples &samples,
                                               const Floats &first, const Floats &second) {
  constexpr int stretch = std::min<int>(lanes, shader::block_samples);
  alignas(vector_bytes) float both[lanes][2];
  for (int lane = 0; lane < lanes; ++lane) {
    both[lane][0] = first[lane];
    both[lane][1] = second[lane];
  }
  for (int lane = 0; lane < lanes; lane += stretch) {
    const std::int32_t *number = samples.number + lane;
    bool follow = true;
    for (int i = 1; i < stretch; ++i)
      follow = follow && number[i] == number[0] + i;
    if (follow) {
      std::memcpy(pairs + std::ptrdiff_t{2} * number[0], both[lane], sizeof(both[0]) * stretch);
      continue;
    }
    for (int i = 0; i < stretch; ++i)
      std::memcpy(pairs + std::ptrdiff_t{2} * number[i], both[lane + i], sizeof(both[0]));
  }
}

// To `channel`, which is even, and the next.
[[gnu::always_inline]] inline void store_channels(const PixelWork &of, std::uint32_t channel,
                                                  const VectorSamples &samples, const Floats &first,
                                                  const Floats &second) {
  store_pairs(of.channels + std::size_t{channel} * of.plane, samples, first, second);
}

// |z| without overflow or underflow of the squares.
Floats magnitude(const Complex &z) {
  const Floats longer = larger(absolute(z.re), absolute(z.im)), re = z.re / longer, im = z.im / longer;
  return longer > 0.0f ? longer * narrow(root(wide(re * re + im * im))) : all(0.0f);
}

// The N correlation samples; `whole`: the return with all of its phase.
void store_taps(const PixelWork &of, const shader::Frequency &frequency, const VectorSamples &samples,
                const Complex &whole) {
  const auto tap = [&](std::uint32_t k) {
    return k < of.kept_taps ? of.tap_phasors[k][0] * whole.re + of.tap_phasors[k][1] * whole.im : all(0.0f);
  };
  for (std::uint32_t k = 0; k < of.kept_taps; k += 2)
    store_channels(of, frequency.first_channel + of.first_tap + k, samples, tap(k), tap(k + 1));
}

// The range, to be rounded to float.
struct Range {
  Wide exact;
  Floats rounded_m; // not known where nothing is hit
};

// What rounding took, and at the ends of its interval the distance's clamping; up to whole ambiguities.
void store_rests(const PixelWork &of, const shader::Frequency &frequency, const VectorSamples &samples,
                 const Floats &distance_rest_m, const Range &range) {
  if (of.keeps_rests)
    store_channels(of, frequency.first_channel + of.rests, samples, distance_rest_m,
                   narrow(range.exact - wide(range.rounded_m)));
}

// The return with all of its phase, and the range.
void store_complex(const PixelWork &of, const shader::Frequency &frequency, const VectorSamples &samples,
                   const Complex &whole, const Range &range) {
  store_channels(of, frequency.first_channel, samples, whole.re, whole.im);
  store_channels(of, frequency.first_channel + 2, samples, all(0.0f), range.rounded_m);
  store_rests(of, frequency, samples, all(0.0f), range);
}

// As store_phase of shaders/signal/demodulation.glsl; `turns` in [-1, 1]. Returns the distance, or 0.
Floats store_phase(const PixelWork &of, const shader::Frequency &frequency, const VectorSamples &samples,
                   const Floats &amplitude, const Wide &turns, const Range &range) {
  const Ints is_known = amplitude > 0.0f;
  const Floats nan = all(std::numeric_limits<float>::quiet_NaN()), none = all(0.0f);
  const Floats rough = narrow(turns);
  Wide within = turns + wide(rough < 0.0f ? all(1.0f) : none);
  within = within - wide(narrow(within) >= 1.0f ? all(1.0f) : none);
  const auto limited = [&](const Wide &value, float below) {
    return is_known ? smaller(larger(narrow(value), none), all(below)) : nan;
  };
  const double ambiguity_m = of_pair(frequency.ambiguity_m);
  store_channels(of, frequency.first_channel, samples, amplitude,
                 limited(within * two_pi, frequency.below.x));
  const Wide distance = within * ambiguity_m;
  const Floats distance_m = limited(distance, frequency.below.y);
  store_channels(of, frequency.first_channel + 2, samples, distance_m, range.rounded_m);
  store_rests(of, frequency, samples, narrow(distance - wide(distance_m)), range);
  return is_known ? distance_m : none;
}

// What the pixels' returns may be off by; `by_field`: pixels whose sums are interpolated.
void hold(const PixelWork &of, std::uint32_t f, const VectorSamples &samples, const Terms &terms,
          const Floats &size, const Floats &distance_m, const Terms &turned, const Ints &by_field,
          HeldPixels &held) {
  const shader::Frequency &frequency = of.frequencies[f];
  Errors errors = errors_of(frequency, terms, size, distance_m, turned);
  Ints is_kept = keeps(frequency, errors);
  if (bits_of(by_field) != 0) {
    const Errors others = errors_of(of.field_frequencies[f], terms, size, distance_m, turned);
    errors = {by_field != 0 ? others.distance_m : errors.distance_m,
              by_field != 0 ? others.amplitude : errors.amplitude};
    is_kept = by_field != 0 ? keeps(of.field_frequencies[f], others) : is_kept;
  }
  if (of.keeps_bounds)
    store_channels(of, frequency.first_channel + of.bound, samples,
                   size > 0.0f ? errors.distance_m : all(std::numeric_limits<float>::quiet_NaN()), all(0.0f));
  held.add(samples, errors, is_kept);
}

// B over the surface's cosine, with the lens's vignetting.
Floats backscatter_of(const PixelWork &of, const VectorSamples &samples) {
  constexpr int after_plane = 8; // words of TrianglePlane
  Floats backscatter =
      of.backscatter ? all(*of.backscatter) : of_planes(of.sums.samples.planes, samples, after_plane);
  if (of.vignetting) {
    const Wide x = load_wide(samples.point_m[0]), y = load_wide(samples.point_m[1]),
               z = load_wide(samples.point_m[2]);
    const Floats cos2 = narrow(z * z / (x * x + y * y + z * z));
    backscatter *= cos2 * cos2;
  }
  return backscatter;
}

void store_lit(const PixelWork &of, const VectorSamples &samples) {
  const shader::Frequency &frequency = of.frequencies[0];
  const Ints reached = gathered(reinterpret_cast<const std::int32_t *>(of.lit), load<Ints>(samples.number));
  const Floats part =
      __builtin_convertvector(reached, Floats) / static_cast<float>(std::max(frequency.diodes, 1u));
  store_channels(of, frequency.lit_channel, samples, load<Ints>(samples.sees) != 0 ? part : all(0.0f),
                 all(0.0f));
}

void store_nothing(const PixelWork &of, const VectorSamples &samples, HeldPixels &held) {
  const Floats none = all(0.0f);
  const Range unknown{Wide(), all(std::numeric_limits<float>::quiet_NaN())};
  for (std::uint32_t f = 0; f < of.frequency_count; ++f) {
    if (of.complex_returns) {
      store_complex(of, of.frequencies[f], samples, Complex(), unknown);
      continue;
    }
    store_phase(of, of.frequencies[f], samples, none, Wide(), unknown);
    store_taps(of, of.frequencies[f], samples, Complex());
    if (of.holds)
      hold(of, f, samples, Terms(), none, none, Terms(), Ints{}, held);
  }
  if (of.mean)
    store_channels(of, of.mean->first_channel, samples, none, none);
  if (of.lit)
    store_lit(of, samples);
}

// Of all runs, over the surfaces' backscatter. Those of each run are kept where they are few.
constexpr std::uint32_t most_kept_runs = 4;
struct Returns {
  Complex z[most_pixel_frequencies]; // relative to twice the sample's own range
  Floats mean;                       // of the light at 0 Hz
  Terms terms;
  Ints by_field; // some run's sums are interpolated
  Wide range;
  Complex of_run[most_kept_runs][most_pixel_frequencies];
  Terms terms_of_run[most_kept_runs];
};

Terms either(const Ints &lanes_of, const Terms &a, const Terms &b) {
  return {lanes_of != 0 ? a.light : b.light, lanes_of != 0 ? a.weights : b.weights,
          lanes_of != 0 ? a.beams : b.beams};
}

bool keeps_runs(const PixelWork &of) {
  return of.holds && of.sums.run_count > 1 && of.sums.run_count <= most_kept_runs;
}

Returns returns_of(const PixelWork &of, VectorSamples &samples, IncidentField *field) {
  Returns returns;
  std::fill_n(returns.z, of.frequency_count, Complex{});
  returns.mean = Floats{};
  returns.terms = Terms();
  returns.by_field = Ints{};
  VectorSources sources(of, samples, field);

  for (std::uint32_t run = 0; run < of.sums.run_count; ++run) {
    const RunForm &form = of.forms[run];
    const PointView view =
        see_points(samples, of.sums.samples.planes, *form.run, form.lambert || form.tests_facing || field);
    Light light;
    sum_light(of, run, samples, view, sources, light);
    for (std::uint32_t f = 0; f < of.frequency_count; ++f) {
      const Complex z = tone_return(form, light, view, of.tones[f]);
      returns.z[f] = returns.z[f] + z;
      if (keeps_runs(of))
        returns.of_run[run][f] = z;
    }
    if (of.mean)
      returns.mean += form.run->mean_over_modulated * light.moment[0];
    if (of.holds) {
      Terms terms = terms_of(form, view, light.weights, light.growth);
      if (bits_of(light.by_field) != 0)
        terms =
            either(light.by_field, terms_of(of.field_forms[run], view, light.weights, light.growth), terms);
      // Polynomials may fall below 0 where no light does.
      const Ints is_lost = light.by_field & ~(light.weights > 0.0f);
      terms.light = (form.run->intensity > 0.0f ? is_lost : Ints{}) != 0
                        ? all(std::numeric_limits<float>::infinity())
                        : terms.light;
      returns.terms = returns.terms + terms;
      if (keeps_runs(of))
        returns.terms_of_run[run] = terms;
    }
    returns.by_field |= light.by_field;
    returns.range = view.range;
  }
  return returns;
}

Terms scaled(const Floats &factor, const Terms &terms) {
  return {factor * terms.light, factor * terms.weights, factor * terms.beams};
}

// Each run's terms times a bound of |sin| of the angle between them and the return: their own phases differ
// by twice the run's path difference at the most, and the run's return lies among them. In place of the
// squares of errors within beams stand these errors.
Terms turned_terms(const PixelWork &of, const Returns &returns, std::uint32_t f) {
  const Floats infinite = all(std::numeric_limits<float>::infinity());
  if (!keeps_runs(of))
    return {infinite, infinite, infinite};
  constexpr float rounding = 1e-4f; // of both returns' angles
  const Complex &z = returns.z[f];
  Terms turned{};
  for (std::uint32_t run = 0; run < of.sums.run_count; ++run) {
    const Complex &part = returns.of_run[run][f];
    const Floats across = absolute(part.im * z.re - part.re * z.im), sizes = magnitude(part) * magnitude(z);
    const float spread = 2.0f * of.tones[f].wavenumber * of.forms[run].path_difference_m + rounding;
    const Floats sine = sizes > smallest ? smaller(across / sizes, all(1.0f)) + spread : all(1.0f);
    const Terms &terms = returns.terms_of_run[run];
    turned = turned +
             scaled(sine, {terms.light, terms.weights, root(larger(terms.light * terms.beams, all(tiny)))});
  }
  return turned;
}

void store_pixels(const PixelWork &of, const VectorSamples &samples, const Returns &returns,
                  HeldPixels &held) {
  const Floats none = all(0.0f), backscatter = backscatter_of(of, samples);
  const Ints sees = load<Ints>(samples.sees) != 0;
  const Ints shines = sees & (backscatter > 0.0f); // black may not be a number
  const Range range{returns.range,
                    sees ? narrow(returns.range) : all(std::numeric_limits<float>::quiet_NaN())};
  const Terms lit = scaled(backscatter, returns.terms);
  const Terms terms{shines ? lit.light : none, shines ? lit.weights : none, shines ? lit.beams : none};
  for (std::uint32_t f = 0; f < of.frequency_count; ++f) {
    const shader::Frequency &frequency = of.frequencies[f];
    Complex z = backscatter * returns.z[f];
    z = {shines ? z.re : none, shines ? z.im : none};
    // The phase stays relative to the range, which makes it exact to the last bit of the output.
    const Wide whole = returns.range * of_pair(frequency.turns_per_m), of_range = whole - rounded(whole);
    const auto with_all_phase = [&] {
      return all(frequency.amplitude_scale) * (z * unit_phasor(narrow(of_range)));
    };
    if (of.complex_returns) {
      store_complex(of, frequency, samples, with_all_phase(), range);
      continue;
    }
    const Floats size = magnitude(z);
    if (of.kept_taps > 0)
      store_taps(of, frequency, samples, with_all_phase());
    const Floats distance_m = store_phase(of, frequency, samples, frequency.amplitude_scale * size,
                                          of_range + wide(angle_turns(z)), range);
    if (of.holds)
      hold(of, f, samples, terms, size, distance_m, scaled(backscatter, turned_terms(of, returns, f)),
           returns.by_field, held);
  }
  if (of.mean)
    store_channels(of, of.mean->first_channel, samples,
                   shines ? larger(of.mean->amplitude_scale * backscatter * returns.mean, none) : none, none);
  if (of.lit)
    store_lit(of, samples);
}

// Whether all that is interpolated keeps what was asked for.
bool field_is_enough(const PixelWork &of, const Returns &returns) {
  for (std::uint32_t f = 0; f < of.frequency_count && bits_of(returns.by_field) != 0; ++f) {
    const shader::Frequency &frequency = of.field_frequencies[f];
    const Errors errors = errors_of(frequency, returns.terms, magnitude(returns.z[f]), all(frequency.below.y),
                                    turned_terms(of, returns, f));
    if (bits_of(returns.by_field & ~keeps(frequency, errors)) != 0)
      return false;
  }
  return true;
}

void make_pixels(const PixelWork &of, VectorSamples &samples, HeldPixels &held,
                 IncidentField *field = nullptr) {
  find_samples(of.sums.samples, samples);
  const int seen = static_cast<int>(std::find(samples.sees, samples.sees + lanes, 1) - samples.sees);
  if (seen == lanes)
    return store_nothing(of, samples, held);
  fill_gaps(samples, seen);
  Returns returns = returns_of(of, samples, field);
  if (of.holds && !field_is_enough(of, returns))
    returns = returns_of(of, samples, nullptr);
  store_pixels(of, samples, returns, held);
  held.end_vector(samples);
}

PixelClaims make_rows(const PixelWork &of, std::uint32_t first, std::uint32_t last) {
  HeldPixels held(of);
  const std::uint32_t columns = of.sums.samples.strip.columns;
  for_each_vector_of_rows(columns, {0, columns}, {first, last},
                          [&](VectorSamples &samples) { make_pixels(of, samples, held); });
  return held.claims();
}

// Cells of the field are numbered row by row of the strip.
PixelClaims make_cells(const PixelWork &of, std::uint32_t first, std::uint32_t last) {
  HeldPixels held(of);
  IncidentField field(of.sums);
  const shader::Strip &strip = of.sums.samples.strip;
  const std::uint32_t side = of.sums.field->side;
  for (std::uint32_t i = first; i < last; ++i) {
    const std::uint32_t column = strip.column / side + i % of.cells_across,
                        row = strip.row / side + i / of.cells_across;
    field.go_to(column, row);
    const auto in_strip = [side](std::uint32_t cell, std::uint32_t begin, std::uint32_t count) {
      return std::pair(std::max(cell * side, begin) - begin, std::min((cell + 1) * side - begin, count));
    };
    const auto [first_column, last_column] = in_strip(column, strip.column, strip.columns);
    const auto [first_row, last_row] = in_strip(row, strip.row, strip.rows);
    for_each_vector_of_rows(strip.columns, {first_column, last_column}, {first_row, last_row},
                            [&](VectorSamples &samples) { make_pixels(of, samples, held, &field); });
  }
  return held.claims();
}

PixelClaims make_blocks(const PixelWork &of, std::uint32_t first, std::uint32_t last) {
  HeldPixels held(of);
  for_each_vector_of_blocks(of.sums.blocks, first, last,
                            [&](VectorSamples &samples) { make_pixels(of, samples, held); });
  return held.claims();
}

} // namespace

extern const PixelLoops pixel_loops;
const PixelLoops pixel_loops{make_rows, make_cells, make_blocks};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
