#pragma once
// The sum of the sizes of a run's terms, which rounding is relative to: terms_of of shaders/light/sum.glsl
// and moments.glsl.

#include "engine/light/host/laws.h"
#include "engine/light/host/point_view.h"
#include "engine/light/host/run_form.h"
#include "engine/model/elementary_lanes.h"

#include <cmath>
#include <numbers>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// As PixelSum::terms in shaders/signal/demodulation.glsl: of the light, of its weights' own errors, and of
// the squares of weights' errors within beams.
struct Terms {
  Floats light, weights, beams;
};

inline Terms operator+(const Terms &a, const Terms &b) {
  return {a.light + b.light, a.weights + b.weights, a.beams + b.beams};
}

// The factor by which the terms of the weights' polynomial in u, all taken as positive, may exceed it.
inline Floats growth_at(const RunForm &form, const PointView &view) {
  const Floats per_rho = inverse(view.rho), t = form.run->radius_m * per_rho;
  const Floats across2 = view.position[0] * view.position[0] + view.position[1] * view.position[1];
  const Floats u = t * (t + 2.0f * (form.coplanar ? root(larger(across2, all(tiny))) * per_rho : all(1.0f)));
  Floats sum = all(0.0f);
  for (std::uint32_t i = form.powers; i-- > 0;)
    sum = sum * u + std::abs(form.run->moments_of_powers[i / 4][static_cast<int>(i % 4)]);
  return sum;
}

// By the exponent of 2 and the rest in [0.71, 1.42); x from 1e-37 on.
inline Floats log2_of(const Floats &x) {
  const Ints shift = (reinterpret_cast<Ints>(x * 1.4142135f) >> 23) - 127;
  const Floats rest = reinterpret_cast<Floats>(reinterpret_cast<Ints>(x) - (shift << 23));
  const Floats y = (rest - 1.0f) / (rest + 1.0f), u = y * y;
  return __builtin_convertvector(shift, Floats) +
         y * (2.885390082f + u * (0.9617966939f + u * (0.5770780164f + u * 0.4121985831f)));
}

// 2^(exponent * log2_x), a hair more than exactly, at most 1e4; not less than 1.
inline Floats power_at_least(const Floats &log2_x, float exponent) {
  const Floats power = smaller(exponent * log2_x, all(14.0f)); // 2^14 > 1e4
  const Floats whole = rounded(power), f = power - whole;
  const Floats fraction =
      1.0f + f * (0.6931471806f +
                  f * (0.2402265070f + f * (0.05550410866f + f * (0.009618129108f + f * 0.001333355815f))));
  const Ints of_two = (__builtin_convertvector(whole, Ints) + 127) << 23;
  return smaller(1.0001f * fraction * reinterpret_cast<Floats>(of_two), all(1e4f));
}

// `near_growth`: of the host's tables, where the frame's polynomials have no powers.
inline Terms terms_of(const RunForm &form, const PointView &view, const Floats &weights,
                      const Floats &near_growth) {
  const shader::LightRun &run = *form.run;
  const Floats none = all(0.0f), per_range = inverse(view.rho - run.radius_m),
               per_range2 = per_range * per_range;
  const Floats facing = form.lambert
                            ? smaller(larger((view.height + run.radius_m) * per_range, all(1e-6f)), all(1.0f))
                            : all(1.0f);
  Floats terms = none, of_beams = none;
  if (form.lambert) {
    const Floats any = run.heights * run.intensity * per_range2 * per_range;
    const Floats lowest = view.height - run.radius_m; // of the run's sources, at least
    terms += lowest > 0.0f ? smaller(any, run.heights * weights * inverse(lowest)) : any;
  }
  if (form.diagrams)
    terms += run.diagrams * per_range2 * facing;
  if (form.beam_edges || form.beams) {
    const Floats all_light = run.brightest * per_range2 * facing; // where J is largest
    const Floats log2_part = log2_of(smaller(larger(weights * inverse(all_light), all(1e-37f)), all(1.0f)));
    if (form.beam_edges)
      terms += smaller(run.beam_edges * weights * power_at_least(log2_part, -run.beam_edge_root),
                       run.beam_edge_most * all_light);
    const Floats x = 1e-5f - std::numbers::ln2_v<float> * log2_part; // a hair more, as it is rounded
    of_beams = weights * x * (run.beams + run.beams_per_log * x);
  }
  const Floats growth = form.powers > 0 ? growth_at(form, view) : near_growth;
  const Ints shines = weights > 0.0f; // where there is no light nothing can be off
  // A hair more, as inverses and roots are rounded.
  constexpr float at_least = 1.00001f;
  return {shines ? growth * weights : none, shines ? at_least * growth * terms : none,
          shines ? at_least * growth * of_beams : none};
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
