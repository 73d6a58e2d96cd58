#include "host/report/frame_findings.h"

#include "engine/model/error.h"
#include "host/report/findings.h"
#include "host/report/report.h"
#include "host/report/view_warnings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <string_view>

namespace pmdsim {
namespace {

constexpr double largest_share_saturated = 0.01; // of a frame's pixels
constexpr double largest_claim = 2.0;            // over what was asked for

bool has_any_above_zero(std::span<const float> values) {
  return std::ranges::any_of(values, [](float value) { return value > 0.0f; });
}

// Of the diodes' light, noise aside. Nothing where no channel tells.
std::optional<bool> has_light(const Measurement &frame) {
  if (!frame.mean_radiance.empty())
    return has_any_above_zero(frame.mean_radiance);
  const bool is_noisy = frame.has_electrons;
  if (frame.returns.empty() || frame.returns.front().amplitude.empty() || is_noisy)
    return std::nullopt;
  return has_any_above_zero(frame.returns.front().amplitude);
}

void add_view(const Setup &setup, const Sensor &sensor, const Measurement &frame,
              std::vector<Warning> &warnings) {
  if (frame.coverage.empty())
    return;
  const bool sees = has_any_above_zero(frame.coverage);
  if (!sees && !has_warned_of(setup, "empty-scene"))
    warnings.push_back(nothing_in_view(setup, sensor, place_of(sensor)));
  else if (sees && has_light(frame) == false && !has_warned_of(setup, "diodes-turned-away") &&
           !has_warned_of(setup, "unseen-harmonics"))
    warnings.push_back({warning_code("all-dark"), place_of(sensor),
                        "it sees the scene, but no diode's light reaches what it sees: turn or move the "
                        "illuminators by their poses, or look for what stands before them (the channel lit); "
                        "surfaces of one side "
                        "are seen and lit from where their corners go round counter-clockwise"});
}

// Where most of what is seen wraps, in all frequencies together.
void add_beyond(const Setup &setup, const Sensor &sensor, const Measurement &frame,
                std::vector<Warning> &warnings) {
  const Spread seen_m = spread_of(std::span<const float>(frame.range_m));
  if (std::isnan(seen_m.min) || has_warned_of(setup, "scene-in-millimetres"))
    return;
  const double reach_m = common_ambiguity_m(sensor.modulation_hz).value_or(sensor.ambiguity_m(0));
  if (seen_m.median < reach_m || sensor.unwrap_range_m >= seen_m.max)
    return;
  std::size_t seen = 0, beyond = 0;
  for (const float range_m : frame.range_m) {
    seen += std::isnan(range_m) ? 0u : 1u;
    beyond += static_cast<double>(range_m) >= reach_m ? 1u : 0u;
  }
  const double share = static_cast<double>(beyond) / static_cast<double>(seen);
  warnings.push_back(beyond_ambiguity(setup, {seen_m.min, seen_m.max, share, reach_m}, place_of(sensor)));
}

void add_saturated(const Sensor &sensor, const Measurement &frame, std::vector<Warning> &warnings) {
  double share = 0.0; // of the worst frequency
  for (const Return &of : frame.returns)
    share = std::max(share, of.share_saturated);
  if (share > largest_share_saturated)
    warnings.push_back(
        {warning_code("saturated"), place_of(sensor),
         fmt::format("a tap was full in {:.3g} % of the pixels (the channel saturated), whose distances are "
                     "wrong: a shorter integration_time_s or a larger lens_f_number helps",
                     100.0 * share)});
}

void add_claim(const Sensor &sensor, std::optional<double> claimed_m, double asked_m, const char *option,
               std::vector<Warning> &warnings) {
  if (claimed_m && *claimed_m > largest_claim * asked_m)
    warnings.push_back({warning_code("claim-above-budget"), place_of(sensor),
                        fmt::format("the error claimed is {:.3g} mm, {:.3g} times what {} asks for: ask for "
                                    "more, or take the frame for what is claimed",
                                    1e3 * *claimed_m, *claimed_m / asked_m, option)});
}

} // namespace

std::vector<Warning> frame_warnings(const Setup &setup, const Sensor &sensor, const Measurement &measurement,
                                    const Accuracy &asked) {
  std::vector<Warning> warnings;
  add_view(setup, sensor, measurement, warnings);
  add_beyond(setup, sensor, measurement, warnings);
  add_saturated(sensor, measurement, warnings);
  if (asked.mode != Mode::exact)
    add_claim(sensor, measurement.accuracy.claimed_m, asked.max_error_m, "--max-error", warnings);
  if (measurement.bounces)
    add_claim(sensor, measurement.bounces->claimed_m, setup.bounces.max_error_m, "bounce_error", warnings);
  if (const auto unpromised = unpromised_warning(measurement.accuracy, asked.max_error_m, sensor))
    warnings.push_back(*unpromised);
  return warnings;
}

void refuse_warnings(const std::vector<Warning> &warnings) {
  if (warnings.empty())
    return;
  const auto &[code, place, text] = warnings.front();
  const bool is_of_error = code == "claim-above-budget" || code == "error-above-asked";
  const std::size_t more = warnings.size() - 1;
  const std::string others =
      more == 0 ? "" : fmt::format("; and {} warning{} more", more, more == 1 ? "" : "s");
  throw Error(is_of_error ? ExitCode::accuracy : ExitCode::input,
              fmt::format("{}: {} [{}]{}; strict makes warnings errors", place, text, code, others),
              {place.substr(0, place.find(": ")),
               place.find(": ") == place.npos ? std::string() : place.substr(place.find(": ") + 2)});
}

} // namespace pmdsim
