#include "tests/comparison/frame_difference.h"

#include <algorithm>
#include <cmath>

namespace pmdsim::test {
namespace {

bool same_unknown(float a, float b) { return std::isnan(a) == std::isnan(b); }

// 0 where either is not known.
double apart(float a, float b) {
  return std::isnan(a) || std::isnan(b) ? 0.0 : std::abs(static_cast<double>(a) - static_cast<double>(b));
}

void compare_returns(const Return &measured, const Return &expected, double ambiguity_m, std::size_t i,
                     FrameDifference &so_far) {
  const double amplitude = expected.amplitude[i];
  if (!same_unknown(measured.distance_m[i], expected.distance_m[i]) ||
      !same_unknown(measured.phase_rad[i], expected.phase_rad[i]) ||
      (measured.amplitude[i] > 0.0f) != (amplitude > 0.0))
    ++so_far.disagreements;
  if (!(amplitude > 0.0))
    return;
  so_far.distance_m =
      std::max(so_far.distance_m,
               std::abs(std::remainder(apart(measured.distance_m[i], expected.distance_m[i]), ambiguity_m)));
  so_far.amplitude =
      std::max(so_far.amplitude, apart(measured.amplitude[i], expected.amplitude[i]) / amplitude);
  for (std::size_t k = 0; k < expected.taps.size(); ++k)
    so_far.taps = std::max(so_far.taps, apart(measured.taps[k][i], expected.taps[k][i]) / amplitude);
}

bool is_empty(const Measurement &frame, std::size_t i) {
  return std::isnan(frame.range_m[i]) && std::isnan(frame.z_m[i]) && frame.triangle_id[i] == no_id &&
         frame.object_id[i] == no_id && std::ranges::all_of(frame.returns, [i](const Return &of_frequency) {
           return of_frequency.amplitude[i] == 0.0f && std::isnan(of_frequency.distance_m[i]) &&
                  std::isnan(of_frequency.phase_rad[i]) &&
                  std::ranges::all_of(of_frequency.taps,
                                      [i](const std::vector<float> &tap) { return tap[i] == 0.0f; });
         });
}

} // namespace

FrameDifference difference(const Measurement &measured, const Measurement &expected, const Sensor &sensor) {
  FrameDifference result;
  for (std::size_t i = 0; i < sensor.pixel_count(); ++i) {
    for (std::size_t f = 0; f < expected.returns.size(); ++f)
      compare_returns(measured.returns[f], expected.returns[f], sensor.ambiguity_m(f), i, result);
    if (measured.coverage[i] != expected.coverage[i] || measured.triangle_id[i] != expected.triangle_id[i] ||
        measured.object_id[i] != expected.object_id[i] ||
        !same_unknown(measured.range_m[i], expected.range_m[i]) ||
        (!expected.lit.empty() && measured.lit[i] != expected.lit[i]))
      ++result.disagreements;
    result.truth_m = std::max({result.truth_m, apart(measured.range_m[i], expected.range_m[i]),
                               apart(measured.z_m[i], expected.z_m[i])});
    result.lit += expected.returns[0].amplitude[i] > 0.0f ? 1u : 0u;
    if (expected.coverage[i] == 0.0f) {
      ++result.empty;
      result.badly_empty += is_empty(measured, i) ? 0u : 1u;
    }
  }
  return result;
}

} // namespace pmdsim::test
