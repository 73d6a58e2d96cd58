#include "engine/tolerance/diode_return.h"

#include "engine/tolerance/radiation.h"

#include <numbers>

namespace pmdsim {
namespace {

// B with its slope over the cosine of incidence.
struct Scattered {
  double value, per_cosine;
};

Scattered scattered(Backscatter backscatter, double gain, double cosine) {
  if (cosine <= 0.0)
    return {0.0, 0.0};
  if (backscatter == Backscatter::constant)
    return {gain, 0.0};
  return {gain * std::numbers::inv_pi * cosine, gain * std::numbers::inv_pi};
}

} // namespace

DiodeReturn diode_return(const LitView &view, const Demodulation &demodulation, const LitPoint &point,
                         const TolerancedDiode &toleranced) {
  const Diode &diode = toleranced.diode;
  const glm::dvec3 to_diode_m = diode.position_m - point.position_m;
  const double range_m = glm::length(to_diode_m);
  const glm::dvec3 to_diode = to_diode_m / range_m, from_diode = -to_diode;
  const double cosine = glm::dot(point.normal, to_diode);
  const Scattered b = scattered(view.backscatter, point.gain, cosine);
  if (b.value == 0.0)
    return {};
  const Radiation j = radiation(diode, from_diode);
  const double nearness = diode.intensity_w_sr / (range_m * range_m), weight = b.value * nearness * j.value;
  const Demodulation::Value of = demodulation.at(
      view.turns_per_m() * (range_m + glm::length(point.position_m)) + toleranced.phase_turns);

  DiodeReturn result{weight, weight * of.of_unit, {}};
  auto *slope = result.slope.data();
  for (int i = 0; i < 3; ++i) { // the illuminator's axes
    const glm::dvec3 &way = toleranced.illuminator_axes[i];
    const double farther = glm::dot(way, to_diode);
    const glm::dvec3 turned = (way - farther * to_diode) / range_m; // of to_diode
    const double weight_slope = nearness * (b.per_cosine * glm::dot(point.normal, turned) * j.value -
                                            b.value * glm::dot(j.slope, turned)) -
                                2.0 * weight * farther / range_m;
    *slope++ = weight_slope * of.of_unit + weight * view.turns_per_m() * farther * of.per_turn;
  }
  for (const glm::dvec3 &towards : {toleranced.towards_x, toleranced.towards_y}) {
    // To the diode, all directions turn the other way.
    const glm::dvec3 turned = glm::cross(from_diode, glm::cross(diode.axis, towards));
    *slope++ = b.value * nearness * glm::dot(j.slope, turned) * of.of_unit;
  }
  *slope++ = result.z;
  *slope++ = weight / radians_per_turn * of.per_turn;
  return result;
}

double product_change(const DiodeReturn &of, std::size_t i, const DiodeReturn &late, bool are_same,
                      const std::complex<double> &z) {
  const std::complex<double> by_error = of.slope[i] / z,
                             by_phase = late.slope[static_cast<std::size_t>(Fault::phase)] / z;
  // What the phase makes of the term that the error changes, as it does of the whole term.
  const std::complex<double> both =
      are_same && of.z != 0.0 ? by_error * late.slope[static_cast<std::size_t>(Fault::phase)] / of.z : 0.0;
  return std::imag(both - by_error * by_phase);
}

} // namespace pmdsim
