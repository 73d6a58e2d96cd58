#pragma once
// Sums over the sources beforehand, as polynomials of the samples' points: sum_beforehand of
// shaders/light/moments.glsl.

#include "engine/light/host/law_sums.h"
#include "engine/light/host/point_view.h"
#include "engine/light/host/run_form.h"
#include "engine/model/elementary_lanes.h"

#include <cstddef>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// The components of S_degree, by Horner's rule; `from` goes on behind their coefficients.
template <std::size_t components, int dimensions>
void add_polynomial(std::uint32_t degree, const Floats (&at)[3], const float *&from, Floats *in_z) {
  for (std::uint32_t l_down = 0; l_down <= (dimensions == 3 ? degree : 0); ++l_down) {
    const std::uint32_t across = dimensions == 3 ? l_down : degree; // the powers of x and y
    Floats in_y[components] = {};
    for (std::uint32_t k_down = 0; k_down <= across; ++k_down) {
      Floats in_x[components] = {};
      for (std::uint32_t j_down = 0; j_down <= k_down; ++j_down)
        for (std::size_t c = 0; c < components; ++c)
          in_x[c] = in_x[c] * at[0] + *from++;
      for (std::size_t c = 0; c < components; ++c)
        in_y[c] = in_y[c] * at[1] + in_x[c];
    }
    for (std::size_t c = 0; c < components; ++c)
      in_z[c] = in_z[c] * at[2] + in_y[c];
  }
}

// As power_of_lengths of shaders/light/radiation_laws.glsl.
inline Floats shared_cosines(const RunForm &form, const PointView &view) {
  if (form.cosines.whole == 0 && form.cosines.rest == 0.0f)
    return all(1.0f);
  const shader::vec4 &axis = form.beforehand->axis;
  const Floats along =
      larger(axis[0] * view.position[0] + axis[1] * view.position[1] + axis[2] * view.position[2] - axis[3],
             all(0.0f));
  return whole_power(along, form.cosines.whole) * fraction_of_power(along / view.rho, form.cosines.rest);
}

template <bool lambert, int dimensions>
void sum_beforehand(const RunForm &form, const PointView &view, Floats *total) {
  constexpr std::size_t components = lambert ? dimensions + 1 : 1;
  const shader::PointPolynomials &head = *form.beforehand;
  const Floats cosines = shared_cosines(form, view);
  const Floats at[3] = {head.per_metre * view.position[0], head.per_metre * view.position[1],
                        head.per_metre * view.position[2]};
  const float *from = form.coefficients;
  for (std::uint32_t i = 0; i < form.powers; ++i) {
    Floats sums[components] = {};
    add_polynomial<components, dimensions>(i, at, from, sums);
    Floats sum = lambert ? sums[0] * view.height : sums[0];
    for (std::size_t axis = 0; axis + 1 < components; ++axis)
      sum += head.unit_m * view.normal[axis] * sums[axis + 1];
    total[i] = cosines * sum;
  }
}

inline void sum_beforehand(const RunForm &form, const PointView &view, Floats *total) {
  if (form.dimensions == 2)
    form.lambert ? sum_beforehand<true, 2>(form, view, total) : sum_beforehand<false, 2>(form, view, total);
  else
    form.lambert ? sum_beforehand<true, 3>(form, view, total) : sum_beforehand<false, 3>(form, view, total);
}

// As find_moments of shaders/light/moments.glsl; `weights`: their sum.
inline void find_moments(const RunForm &form, const PointView &view, const Floats *total, Floats *moment,
                         Floats &weights) {
  const Floats per_rho = 1.0f / view.rho;
  Floats scale = per_rho * per_rho;
  const Floats inverse_rho2 = form.beforehand->unit_m2 * scale;
  for (std::uint32_t i = 0; i < form.cosines.whole + (form.lambert ? 1 : 0); ++i)
    scale *= per_rho;
  weights = scale * total[0];
  for (std::uint32_t k = 0; k < form.moments; ++k) {
    Floats sum = all(0.0f);
    for (std::uint32_t i = form.powers; i-- > 0;)
      sum = sum * inverse_rho2 +
            form.run->moments_of_powers[shader::largest_powers / 4 * k + i / 4][static_cast<int>(i % 4)] *
                total[i];
    moment[k] = scale * sum;
    scale *= view.rho;
  }
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
