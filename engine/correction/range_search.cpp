#include "engine/correction/range_search.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

// A step of that length leaves less than a nanometre.
constexpr double last_step_m = 1e-8;
constexpr double least_range_m = 1e-6;
constexpr int most_steps = 50;

double angle_between(const std::complex<double> &z, double phase_rad) {
  return std::arg(z * std::polar(1.0, -phase_rad));
}

double phase_slope(const ModelReturn &model) {
  return std::imag(std::conj(model.z) * model.per_m) / std::norm(model.z);
}

} // namespace

RangeSearch::RangeSearch(const Sensor &sensor, const std::vector<Illuminator> &illuminators,
                         const CorrectionOptions &options)
    : rows_(diode_rows(sensor, illuminators)), demodulation_(demodulation_of(sensor)),
      turns_per_m_(sensor.modulation_hz.at(options.frequency) / speed_of_light_m_s),
      ambiguity_m_(sensor.ambiguity_m(options.frequency)),
      lambert_(options.backscatter == Backscatter::lambert),
      vignetting_(sensor.vignetting == Vignetting::cos4) {}

ModelReturn RangeSearch::model_return(const PointOnRay &at, bool with_normal) const {
  ModelReturn sum{};
  const ReturnWork work{rows_, demodulation_, turns_per_m_, lambert_};
  widest_return_loops(512).sum(work, at, with_normal, sum);
  return sum;
}

FoundRange RangeSearch::nearest(const PointOnRay &start, double phase_rad) const {
  const double monostatic_slope = 2.0 * radians_per_turn * turns_per_m_;
  PointOnRay at = start;
  at.range_m = std::max(start.range_m, least_range_m);
  // The last range, and those where the phase is too short and too long.
  std::optional<std::pair<double, double>> last, shorter, longer;
  for (int step = 0; step < most_steps; ++step) {
    const ModelReturn model = model_return(at);
    if (model.z == 0.0)
      return {at.range_m, PixelStatus::no_light};
    const double off_rad = angle_between(model.z, phase_rad);
    if (!std::isfinite(off_rad))
      break;
    double slope = phase_slope(model);
    if (last && std::abs(at.range_m - last->first) > last_step_m) {
      const double secant = (off_rad - last->second) / (at.range_m - last->first);
      slope = secant > 0.1 * monostatic_slope && secant < 10.0 * monostatic_slope ? secant : slope;
    }
    if (!(slope > 0.1 * monostatic_slope))
      slope = monostatic_slope;
    last = {at.range_m, off_rad};
    if (std::abs(off_rad) < 0.25 * radians_per_turn)
      (off_rad < 0.0 ? shorter : longer) = last;
    double next = at.range_m - std::clamp(off_rad / slope, -0.25 * ambiguity_m_, 0.25 * ambiguity_m_);
    if (shorter && longer &&
        (next <= std::min(shorter->first, longer->first) || next >= std::max(shorter->first, longer->first)))
      next = 0.5 * (shorter->first + longer->first);
    if (next < least_range_m)
      next = 0.5 * at.range_m;
    const double moved = std::abs(next - at.range_m);
    at.range_m = next;
    if (moved < last_step_m)
      return {next, PixelStatus::corrected};
    if (at.range_m < least_range_m)
      break;
  }
  return {at.range_m, PixelStatus::not_converged};
}

FoundRange RangeSearch::within(const PointOnRay &start, double phase_rad, double least_m) const {
  PointOnRay from = start;
  FoundRange found{};
  constexpr int most_turns = 4;
  for (int turn = 0; turn < most_turns; ++turn) {
    found = nearest(from, phase_rad);
    const double turns = std::floor((found.range_m - least_m) / ambiguity_m_);
    if (found.status == PixelStatus::corrected && turns == 0.0)
      return found;
    from.range_m = found.range_m - (turns == 0.0 ? -1.0 : turns) * ambiguity_m_;
  }
  if (found.status == PixelStatus::corrected)
    found.status = PixelStatus::not_converged;
  return found;
}

double RangeSearch::phase_excess_rad(const PointOnRay &at, std::span<const PointOnRay> around) const {
  std::complex<double> mean = 0.0;
  for (const PointOnRay &point : around) {
    const double square = point.ray.z * point.ray.z, weight = vignetting_ ? square * square : 1.0;
    mean += weight * model_return(point).z;
  }
  const std::complex<double> centre = model_return(at).z;
  return mean == 0.0 || centre == 0.0 ? 0.0 : std::arg(mean * std::conj(centre));
}

glm::dvec3 RangeSearch::range_per_normal_m(const PointOnRay &at) const {
  if (!lambert_)
    return glm::dvec3(0.0);
  const ModelReturn model = model_return(at, true);
  const double slope = phase_slope(model) * std::norm(model.z);
  glm::dvec3 per_normal;
  for (int axis = 0; axis < 3; ++axis)
    per_normal[axis] = -std::imag(std::conj(model.z) * model.per_normal[axis]) / slope;
  return per_normal;
}

} // namespace pmdsim
