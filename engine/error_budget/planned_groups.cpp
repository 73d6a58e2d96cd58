#include "engine/error_budget/planned_groups.h"

#include <algorithm>
#include <numbers>

namespace pmdsim {
namespace {

constexpr double largest_tolerance = 0x1p-14; // no more is worth it

// In runs of at most so many blocks.
SourceGroups in_runs_of(std::uint32_t most_blocks, const LightFacts &view,
                        const std::vector<CameraIlluminator> &lights, Precision precision, double tolerance,
                        double near_growth) {
  const double wavenumber_rad_m = view.modulation.largest_wavenumber_rad_m();
  SourceGroups groups =
      group_diodes(lights, view.visible, wavenumber_rad_m, precision, most_blocks, tolerance);
  groups.near_growth = near_growth;
  const bool host_sums = view.on_host && view.sensor.samples == 1 && near_growth > 1.0 &&
                         view.modulation.waveform == shader::waveform_sine;
  if (precision == Precision::fp32 && view.modulation.by_moments())
    choose_polynomials(groups, view.model, wavenumber_rad_m, view.allowed, host_sums);
  return groups;
}

} // namespace

std::vector<double> wavenumbers_rad_m(const Modulation &modulation) {
  std::vector<double> result;
  for (const double modulation_hz : modulation.modulation_hz)
    result.push_back(2.0 * std::numbers::pi * modulation_hz / speed_of_light_m_s);
  return result;
}

double tolerance_of(const LightFacts &view, Precision precision, const Accuracy &accuracy, double share) {
  if (precision == Precision::fp64)
    return 0.0;
  const std::vector<double> wavenumbers = wavenumbers_rad_m(view.modulation);
  const double angle_rad = 2.0 * *std::ranges::max_element(wavenumbers) * accuracy.max_error_m;
  return std::min(share * std::min(angle_rad, accuracy.max_amplitude_error), largest_tolerance);
}

double growth_of(const SourceGroups &groups) {
  return groups.near_polynomials ? groups.near_polynomials->growth : groups.polynomials.growth;
}

SourceGroups groups_of(const LightFacts &view, const std::vector<CameraIlluminator> &lights,
                       Precision precision, double tolerance, double near_growth) {
  SourceGroups groups = in_runs_of(usual_run_blocks, view, lights, precision, tolerance, near_growth);
  // What series leave out counts as rounding does, which grows.
  if (const double growth = growth_of(groups); growth > 1.0 && tolerance > 0.0) {
    tolerance /= growth;
    groups = in_runs_of(usual_run_blocks, view, lights, precision, tolerance, near_growth);
  }
  // A window of shadows' bits holds no long run.
  const bool long_runs =
      view.on_host && groups.polynomials.equal_weights && groups.runs.size() > 1 && !view.modulation.lit;
  return long_runs ? in_runs_of(long_run_blocks, view, lights, precision, tolerance, near_growth) : groups;
}

} // namespace pmdsim
