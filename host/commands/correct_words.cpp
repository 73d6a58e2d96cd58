#include "host/commands/correct_words.h"

#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

Spread correction_mm(const Outcome &of) {
  std::vector<double> values = of.corrected.correction_m;
  for (double &value : values)
    value *= 1e3;
  return spread_of(values);
}

bool is_phase(const MeasuredFile &measured) { return measured.meaning.quantity == Quantity::phase; }

// What the image was taken for.
std::string values_text(const MeasuredFile &measured) {
  const Spread values = spread_of(measured.values);
  return fmt::format("{} in {}: min {}, median {}, max {}", quantity_name(measured.meaning.quantity),
                     is_phase(measured) ? "radians" : "metres", table_number(values.min),
                     table_number(values.median), table_number(values.max));
}

ordered_json values_json(const MeasuredFile &measured) {
  const Spread values = spread_of(measured.values);
  return {{"quantity", quantity_name(measured.meaning.quantity)},
          {"unit", is_phase(measured) ? "rad" : "m"},
          {"min", values.min},
          {"median", values.median},
          {"max", values.max}};
}

double ambiguity_m(const Outcome &of) { return of.scenery.camera().ambiguity_m(of.options.image.frequency); }

std::string pixels_text(const Outcome &of) {
  const std::size_t pixels = of.corrected.status.size();
  const std::size_t corrected = of.count(PixelStatus::corrected) + of.count(PixelStatus::edge);
  const auto share = [&](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(pixels);
  };
  std::string text = fmt::format("corrected  {} of {} pixels", corrected, pixels);
  if (const std::size_t edges = of.count(PixelStatus::edge))
    text += fmt::format(
        ", of these {} ({:.1f} %) at edges, where an uncertain normal may move them by more than {}", edges,
        share(edges), micrometres_text(of.corrected.edge_limit_m));
  const std::array reasons{std::pair(PixelStatus::not_measured, "nothing was measured there"),
                           std::pair(PixelStatus::no_light, "no diode reaches the ray"),
                           std::pair(PixelStatus::not_converged, "no range found")};
  for (const auto &[status, reason] : reasons)
    if (of.count(status) > 0)
      text += fmt::format("\n           {} not: {}", of.count(status), reason);
  return text + '\n';
}

// What a pixel's measure is taken for.
std::string samples_text(const Sensor &sensor) {
  return sensor.samples < 2 ? "of which each measures its centre"
                            : fmt::format("each the mean of {0} x {0} samples", sensor.samples);
}

std::string turns_text(const Outcome &of) {
  const double least_m = of.options.image.least_range_m.value_or(0.0);
  std::string text = of.measured.turns.empty() ? fmt::format("turns      ranges from {:g} m to {:.4g} m",
                                                             least_m, least_m + ambiguity_m(of))
                                               : fmt::format("turns      by {}", of.measured.turns);
  if (of.measured.beyond_ambiguity > 0)
    text += fmt::format("; stray distances beyond the ambiguity range, taken back into it: {}",
                        of.measured.beyond_ambiguity);
  return text + '\n';
}

std::string truth_text(const Outcome &of) {
  if (of.truth.empty())
    return "";
  std::string text = fmt::format("\nerror against {}, um\n{}", of.truth, error_text(of.errors));
  const std::size_t compared = of.count(PixelStatus::corrected) + of.count(PixelStatus::edge);
  if (constexpr std::size_t one_in = 100; of.wrong_turns * one_in > compared)
    text += fmt::format(
        "{} pixels are off by about whole ambiguity ranges of {:.4g} m: --least-range, --guess or "
        "--unwrap tells their turn\n",
        of.wrong_turns, ambiguity_m(of));
  constexpr double rounding_m = 2e-6; // of distances as floats
  if (const double noise_m = of.corrected.noise_m; noise_m > rounding_m)
    text += fmt::format("{} of noise in each range pass through; means over the image are known to ±{}\n",
                        micrometres_text(noise_m),
                        micrometres_text(noise_m / std::sqrt(static_cast<double>(compared))));
  return text;
}

} // namespace

ordered_json json_of(const Outcome &of) {
  const Spread correction = correction_mm(of);
  const CorrectedImage &corrected = of.corrected;
  ordered_json json{
      {"image", of.measured.source},
      {"values", values_json(of.measured)},
      {"turns", of.measured.turns.empty() ? ordered_json(nullptr) : ordered_json(of.measured.turns)},
      {"stray_distances", of.measured.beyond_ambiguity},
      {"sensor", of.scenery.camera().name},
      {"modulation_hz", of.scenery.camera().modulation_hz[of.options.image.frequency]},
      {"pixels",
       {{"corrected", of.count(PixelStatus::corrected)},
        {"edge", of.count(PixelStatus::edge)},
        {"not_measured", of.count(PixelStatus::not_measured)},
        {"no_light", of.count(PixelStatus::no_light)},
        {"not_converged", of.count(PixelStatus::not_converged)}}},
      {"correction_mm", {{"min", correction.min}, {"median", correction.median}, {"max", correction.max}}},
      {"noise_um", 1e6 * corrected.noise_m},
      {"edge_limit_um", 1e6 * corrected.edge_limit_m},
      {"fit_pixels", corrected.fit_pixels},
      {"passes", corrected.passes},
      {"not_taken_off", of.effects},
      {"camera", camera_json(of.scenery.camera())}};
  if (!of.truth.empty()) {
    json["truth"] = of.truth;
    json["errors"] = error_json(of.errors);
    json["wrong_turns"] = of.wrong_turns;
  }
  json["warnings"] = array_of(of.warnings, warning_json);
  json["outputs"] = of.outputs;
  return json;
}

std::string text_of(const Outcome &of) {
  const Sensor &sensor = of.scenery.camera();
  std::string text = fmt::format(
      "image      {}\n           {}\nsensor     {}, {} x {} pixels, {}, {}, {} diodes\n", of.measured.source,
      values_text(of.measured), sensor.name, sensor.resolution.x, sensor.resolution.y, samples_text(sensor),
      frequency_text(sensor.modulation_hz[of.options.image.frequency]),
      diode_count(of.scenery.instant.illuminators));
  text += turns_text(of);
  text += pixels_text(of);
  const Spread correction = correction_mm(of);
  text += fmt::format("correction {} mm to {} mm, median {} mm\n", table_number(correction.min),
                      table_number(correction.max), table_number(correction.median));
  if (of.options.normals == NormalsFrom::neighbours)
    text += fmt::format("normals    of planes fitted to {0} x {0} pixels; noise of ranges {1}\n",
                        2 * of.corrected.fit_pixels + 1, micrometres_text(of.corrected.noise_m));
  if (!of.effects.empty())
    text += fmt::format("not taken off: {}\n", fmt::join(of.effects, "; "));
  return text + truth_text(of) + fmt::format("\nwritten:\n  {}\n", fmt::join(of.outputs, "\n  "));
}

} // namespace pmdsim
