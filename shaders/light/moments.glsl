// A run's sum by moments (docs/theory.md, "The sum by moments"). With the group's reference point G, rho = |P - G| and e = r_nm -
// rho, the return is
//   exp(j 2 pi (rho + r_n) / lambda) * sum_k (j kappa)^k / k! * sum_m w_m e_m^k,    kappa = 2 pi f / c,
// so the loop over the diodes holds no sine and no long path: float32 is enough for it at any range.
#ifndef PMDSIM_MOMENTS_GLSL
#define PMDSIM_MOMENTS_GLSL

#include "shaders/light/sum.glsl"

layout(constant_id = constant_moments) const uint moments = 4;
layout(constant_id = constant_tones) const uint tones = 1;

// The sums over the diodes: sum_m w_m e_m^k or, where `powers` is not 0, S_i = sum_m (w_m r_m^p) q_m^i.
const uint sums = powers > 0 ? powers : moments;
// With equal weights S_0 is known and S_1 is linear in the point: neither needs the loop.
const bool linear_known = equal_weights != 0 && powers > 2;

// A run's diodes may be summed beforehand (engine/light/point_polynomials.h).
layout(constant_id = constant_point_dimensions) const uint point_dimensions = 0;
// Or the host has summed them, sample by sample (engine/light/host/law_sums.h).
layout(constant_id = constant_summed_by_host) const uint summed_by_host = 0;

// Diodes of equal weights are stored as places only.
GroupSource load_diode(uvec2 diodes, uint i) {
  if (equal_weights == 0)
    return Diodes(diodes).at[i];
  GroupSource diode;
  diode.position = Vec4s(diodes).at[i];
  return diode;
}

void add_block(inout float total[sums], Point point, uvec2 diodes, uint block, uint reached) {
  float part[sums];
  [[unroll]] for (uint k = 0; k < sums; ++k)
    part[k] = 0.0;
  [[unroll]] for (uint d = 0; d < diodes_per_block; ++d) {
    GroupSource diode = load_diode(diodes, block * diodes_per_block + d);
    bool is_reached = (reached & 1u << d) != 0u;
    vec2 factors = powers > 0 ? strength_and_detour(point, diode, is_reached) : weight_and_difference(point, diode, is_reached);
    float term = factors.x;
    if (equal_weights == 0)
      part[0] += term;
    [[unroll]] for (uint k = 1; k < sums; ++k) {
      term = k == 1 && equal_weights != 0 ? factors.y : term * factors.y;
      if (k > 1 || !linear_known)
        part[k] += term;
    }
  }
  [[unroll]] for (uint k = 0; k < sums; ++k)
    total[k] += part[k];
}

// The sum of a run's weights, and the factor by which the terms of their polynomial in u, all taken as positive, may exceed it:
// rounding grows by that factor. |u| <= t^2 + 2 t |P - G| / rho, t the run's radius over rho. Only the part of P - G in the
// diodes' plane counts where the diodes are coplanar.
struct Weights {
  float sum, growth;
};

float largest_u(Point point, LightRun run) {
  float inverse = 1.0 / point.rho, t = run.radius_m * inverse;
  return t * (t + 2.0 * (coplanar != 0 ? length(point.position.xy) * inverse : 1.0));
}

float growth_at(Point point, LightRun run) {
  float u = largest_u(point, run);
  float sum = 0.0;
  [[unroll]] for (uint down = 0; down < powers; ++down) {
    uint i = powers - 1 - down;
    sum = sum * u + abs(run.moments_of_powers[i / 4][i % 4]);
  }
  return sum;
}

// With w = (w r^p) rho^-p (1 + u)^(-p/2), e = rho (sqrt(1 + u) - 1) and u = q / rho^2 both are functions of u, for which the run has
// polynomials (moment_polynomials.h): one step a sample in place of a root and a division for each diode.
// `unit_m2`: of the sums, by their power of q.
void find_moments(float total[sums], float unit_m2, Point point, LightRun run, out float moment[moments], out Weights weights) {
  // The lengths in a weight, beside its intensity.
  const uint lengths = (backscatter_model == backscatter_lambert ? 1 : 0) + (pattern_model == pattern_power ? cosine_order : 0);
  float scale = 1.0 / (point.rho * point.rho), inverse_rho2 = unit_m2 * scale;
  if (powers > 0)
    [[unroll]] for (uint i = 0; i < lengths; ++i)
      scale /= point.rho;
  if (equal_weights != 0 && point_dimensions == 0)
    total[0] = run.intensity; // those that pad a run have none, and q = 0
  weights = Weights(total[0], 1.0);
  if (powers > 0)
    weights = Weights(scale * total[0], growth_at(point, run));
  if (linear_known && point_dimensions == 0)
    [[unroll]] for (uint k = 1; k < min(2, sums); ++k)
      total[k] = dot(run.detours.xyz, point.position) + run.detours.w;
  [[unroll]] for (uint k = 0; k < moments; ++k) {
    float sum = 0.0;
    [[unroll]] for (uint down = 0; down < powers; ++down) {
      uint i = powers - 1 - down;
      sum = sum * inverse_rho2 + run.moments_of_powers[largest_powers / 4 * k + i / 4][i % 4] * total[i];
    }
    moment[k] = powers > 0 ? scale * sum : total[k];
    scale *= point.rho;
  }
}

// The sums of powers of q from polynomials of the point. Loops have constant ends and are cut by constant conditions: a loop whose
// end another one's counter tells is not unrolled.
const uint components = backscatter_model == backscatter_lambert ? point_dimensions + 1 : 1;

uint triangular(uint n) { return n * (n + 1) / 2; }
uint tetrahedral(uint n) { return n * (n + 1) * (n + 2) / 6; }

// One component of S_degree, by Horner's rule; `first` is the degree's first coefficient.
float polynomial_of(Floats from, uint first, uint degree, uint component, vec3 at) {
  float in_z = 0.0;
  [[unroll]] for (uint l_down = 0; l_down < (point_dimensions == 3 ? powers : 1); ++l_down) {
    uint l = (point_dimensions == 3 ? powers - 1 : 0) - l_down;
    float in_y = 0.0;
    [[unroll]] for (uint k_down = 0; k_down < powers; ++k_down) {
      uint k = powers - 1 - k_down;
      float in_x = 0.0;
      [[unroll]] for (uint j_down = 0; j_down < powers; ++j_down) {
        uint j = powers - 1 - j_down, n = j + k + l;
        uint place = point_dimensions == 3 ? tetrahedral(n) + triangular(k + l) + l : triangular(n) + k;
        if (n <= degree)
          in_x = in_x * at.x + from.at[first + place * components + component];
      }
      in_y = in_y * at.y + in_x;
    }
    in_z = in_z * at.z + in_y;
  }
  return in_z;
}

void sum_beforehand(Point point, uvec2 polynomials, out float total[sums], out float unit_m2) {
  PointPolynomials head = PointPolynomialsOf(polynomials).at;
  Floats from = Floats(polynomials);
  unit_m2 = head.unit_m2;
  float shared_cosines = 1.0;
  if (pattern_model == pattern_power)
    shared_cosines = power_of_lengths(max(0.0, dot(head.axis.xyz, point.position) - head.axis.w), point.rho);
  vec3 at = head.per_metre * point.position;
  [[unroll]] for (uint i = 0; i < sums; ++i) {
    uint before = point_dimensions == 3 ? i * (i + 1) * (i + 2) * (i + 3) / 24 : tetrahedral(i);
    uint first = 8 + before * components;
    float sum = polynomial_of(from, first, i, 0, at);
    if (backscatter_model == backscatter_lambert) {
      sum *= point.height;
      [[unroll]] for (uint axis = 0; axis < point_dimensions; ++axis)
        sum += head.unit_m * point.normal[axis] * polynomial_of(from, first, i, axis + 1, at);
    }
    total[i] = shared_cosines * sum;
  }
}

// A bit for each diode of a run's block, counted from the run's first, that reaches sample i. It is asked only where `shadowed`.
#ifndef VISIBILITY_OF_BLOCK
#define VISIBILITY_OF_BLOCK(i, block) 0u
#endif

// The run's k-th moment at sample i, and behind them the sum that its polynomials' terms are held against. It is asked only where
// `summed_by_host`.
#ifndef MOMENT_OF_RUN
#define MOMENT_OF_RUN(i, k) 0.0
#endif

void load_moments(uint i, Point point, LightRun run, out float moment[moments], out Weights weights) {
  [[unroll]] for (uint k = 0; k < moments; ++k)
    moment[k] = MOMENT_OF_RUN(i, k);
  weights = Weights(MOMENT_OF_RUN(i, moments), 1.0);
  if (powers > 0)
    weights.growth = growth_at(point, run);
}

// Adds a block to a stretch, and the stretch, where it ends, to the run's sums.
void add_block_of_run(inout float total[sums], inout float stretch[sums], Point point, uvec2 diodes, uint first, uint block,
                      uint reached) {
  add_block(stretch, point, diodes, first + block, reached);
  bool ends = block % blocks_per_stretch == blocks_per_stretch - 1;
  [[unroll]] for (uint k = 0; k < sums; ++k) {
    total[k] += ends ? stretch[k] : 0.0;
    stretch[k] = ends ? 0.0 : stretch[k];
  }
}

// The moments of a run whose diodes begin with block `first`, at sample i. `blocks`: of it, for the looped form. Long runs are
// summed stretch by stretch, so that rounding is no worse than of short ones.
void sum_run(uint i, Point point, LightRun run, uvec2 diodes, uint first, uint blocks, out float moment[moments],
             out Weights weights) {
  float total[sums], stretch[sums];
  if (summed_by_host != 0) {
    load_moments(i, point, run, moment, weights);
    return;
  }
  if (point_dimensions > 0) {
    float unit_m2;
    sum_beforehand(point, diodes, total, unit_m2);
    find_moments(total, unit_m2, point, run, moment, weights);
    return;
  }
  [[unroll]] for (uint k = 0; k < sums; ++k)
    total[k] = stretch[k] = 0.0;
  if (straight != 0) {
    [[unroll]] for (uint block = 0; block < blocks_per_run; ++block)
      add_block_of_run(total, stretch, point, diodes, first, block, VISIBILITY_OF_BLOCK(i, block));
  } else {
    for (uint block = 0; block < blocks; ++block)
      add_block_of_run(total, stretch, point, diodes, first, block, VISIBILITY_OF_BLOCK(i, block));
  }
  [[unroll]] for (uint k = 0; k < sums; ++k)
    total[k] += stretch[k];
  find_moments(total, 1.0, point, run, moment, weights);
}

vec3 terms_of(Weights weights, Point point, LightRun run) {
  return weights.growth * terms_of(weights.sum, point.rho, point.height, run);
}

// sum_k (j kappa)^k / k! * moment[k], by Horner's rule.
vec2 return_of(float moment[moments], float kappa) {
  vec2 z = vec2(0.0);
  [[unroll]] for (uint down = 0; down < moments; ++down) {
    uint k = moments - 1 - down;
    z = vec2(moment[k], 0.0) + vec2(-z.y, z.x) * (kappa / float(k + 1));
  }
  return z;
}

// The return relative to twice the sample's own range, which the demodulation turns back. The way over the reference point is
// longer than that by rho - range.
vec2 tone_return(float moment[moments], ReferencePath path, LightRun run, Tone tone) {
  Real detour = add(path.rho, negate(path.range));
  vec2 z = complex_multiply(return_of(moment, tone.wavenumber), unit_phasor(turn_fraction(phase_turns(detour, run, tone))));
  return keeps_mean != 0 ? light_of_tone(run, tone) * z : z;
}

#endif
