#include "host/report/electron_findings.h"

#include "engine/electronics/photon_chain.h"
#include "engine/reference/reference.h"
#include "host/output/files/manifest.h"
#include "host/report/findings.h"
#include "host/report/report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace pmdsim {
namespace {

constexpr double coarse_columns = 48.0; // along the frame's longer side
constexpr double affordable_interactions = 2e7;

// Every diode lights every pixel.
double columns_for(const Setup &setup) {
  auto diodes = static_cast<double>(diode_count(setup.start.illuminators));
  for (const OtherIlluminator &other : setup.start.others)
    diodes += static_cast<double>(other.illuminator.diodes.size());
  return std::clamp(std::sqrt(affordable_interactions / diodes), 8.0, coarse_columns);
}

// The fullest that a tap may be.
double most_of_tap_e(const Electronics &electronics) {
  const double of_adc_e = (electronics.largest_dn() - electronics.offset_dn) / electronics.gain_dn_per_e;
  return std::min(electronics.full_well_e, of_adc_e);
}

// The mean of the fullest tap of all images, at any frequency, after the suppression of background.
double fullest_e(const Sensor &sensor, const reference::Frame &frame, std::size_t pixel,
                 const ImageElectrons &image) {
  const Electronics &electronics = *sensor.electronics;
  double fullest = 0.0;
  for (std::size_t f = 0; f < frame.returns.size(); ++f)
    for (const std::vector<double> &tap : frame.returns[f].taps) {
      const double sample_e = electrons_of(tap[pixel], sensor);
      const auto [a_e, b_e] = tap_electrons(image, sample_e, electronics.contrast(f));
      if (!electronics.two_tap) {
        fullest = std::max(fullest, a_e);
        continue;
      }
      const double over_e = std::max(std::max(a_e, b_e) - electronics.full_well_e, 0.0);
      const double taken_e = std::min({over_e, electronics.sbi_e, std::min(a_e, b_e)});
      fullest = std::max(fullest, std::max(a_e, b_e) - taken_e);
    }
  return fullest;
}

// At a pixel of a coarser frame.
double background_at(const Sensor &sensor, const glm::uvec2 &coarse, std::size_t pixel) {
  const Electronics &electronics = *sensor.electronics;
  if (electronics.background_image.empty())
    return electronics.background_radiance_w_m2_sr;
  const std::size_t column = pixel % coarse.x, row = pixel / coarse.x;
  const glm::dvec2 middle(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  const glm::uvec2 at(middle / glm::dvec2(coarse) * glm::dvec2(sensor.resolution));
  const float relative = electronics.background_image[std::size_t{at.y} * sensor.resolution.x + at.x];
  return electronics.background_radiance_w_m2_sr * static_cast<double>(relative);
}

// The mean light of other cameras; empty: none. Their beat depends on when a frame is taken.
std::vector<double> others_mean(const Setup &setup, const Sensor &coarse) {
  std::vector<Illuminator> illuminators;
  for (const OtherIlluminator &other : setup.start.others)
    illuminators.push_back(other.illuminator);
  if (illuminators.empty())
    return {};
  return reference::simulate(setup.start.scene, coarse, illuminators, setup.backscatter,
                             {.shadows = setup.shadows})
      .mean_radiance;
}

void take_noise(ElectronFindings &findings, double noise_m) {
  findings.least_noise_m = std::min(findings.least_noise_m.value_or(noise_m), noise_m);
  findings.most_noise_m = std::max(findings.most_noise_m.value_or(noise_m), noise_m);
}

} // namespace

std::optional<ElectronFindings> electron_findings(const Setup &setup, const Sensor &sensor) {
  if (!sensor.electronics)
    return std::nullopt;
  const Electronics &electronics = *sensor.electronics;
  Sensor coarse = coarser(sensor, std::max(sensor.resolution.x, sensor.resolution.y) / columns_for(setup));
  coarse.samples = 1;
  const reference::Frame frame = reference::simulate(setup.start.scene, coarse, setup.start.illuminators,
                                                     setup.backscatter, {.shadows = setup.shadows});
  const std::vector<double> others = others_mean(setup, coarse);
  ElectronFindings findings;
  findings.dark_e = electronics.dark_current_e_per_s * electronics.integration_time_s;
  findings.darkest_e = std::numeric_limits<double>::infinity();
  std::size_t seen = 0, full = 0;
  for (std::size_t pixel = 0; pixel < frame.coverage.size(); ++pixel) {
    if (frame.coverage[pixel] == 0.0)
      continue;
    ++seen;
    const double foreign =
        background_at(sensor, coarse.resolution, pixel) + (others.empty() ? 0.0 : others[pixel]);
    const ImageElectrons image{electrons_of(frame.mean_radiance[pixel], sensor),
                               electrons_of(foreign, sensor), findings.dark_e};
    findings.background_e = std::max(findings.background_e, image.background_e);
    findings.brightest_e = std::max(findings.brightest_e, image.signal_e);
    findings.darkest_e = std::min(findings.darkest_e, image.signal_e);
    const double over = fullest_e(sensor, frame, pixel, image) / most_of_tap_e(electronics);
    findings.fullest_over_well = std::max(findings.fullest_over_well, over);
    full += over > 1.0 ? 1u : 0u;
    const double modulated_e = electrons_of(frame.returns[0].amplitude[pixel], sensor);
    if (modulated_e > 0.0 && over <= 1.0)
      take_noise(findings, phase_noise_rad(image, modulated_e, frame.returns[0].phase_rad[pixel], sensor) *
                               sensor.ambiguity_m() / (2.0 * std::numbers::pi));
  }
  if (seen == 0)
    return std::nullopt;
  findings.share_full = static_cast<double>(full) / static_cast<double>(seen);
  return findings;
}

std::string electrons_text(const ElectronFindings &findings) {
  std::string text = fmt::format(
      "{:.3g} e of the diodes' light an image in the brightest pixel, {:.3g} e in the darkest, {:.3g} e of "
      "foreign light, {:.3g} e in the dark; the fullest tap has {:.3g} % of what it can hold",
      findings.brightest_e, findings.darkest_e, findings.background_e, findings.dark_e,
      100.0 * findings.fullest_over_well);
  if (findings.least_noise_m)
    text += fmt::format("; noise of distance {:.3g} mm to {:.3g} mm", 1e3 * *findings.least_noise_m,
                        1e3 * *findings.most_noise_m);
  return text;
}

nlohmann::ordered_json electrons_json(const std::optional<ElectronFindings> &findings) {
  if (!findings)
    return nullptr;
  return {{"brightest_e", findings->brightest_e},
          {"darkest_e", findings->darkest_e},
          {"background_e", findings->background_e},
          {"dark_e", findings->dark_e},
          {"fullest_tap_over_well", findings->fullest_over_well},
          {"share_saturated", findings->share_full},
          {"distance_noise_m", {or_null(findings->least_noise_m), or_null(findings->most_noise_m)}}};
}

std::optional<Warning> full_warning(const Sensor &sensor, const ElectronFindings &findings) {
  if (findings.share_full == 0.0)
    return std::nullopt;
  return Warning{
      warning_code("full-taps"), place_of(sensor),
      fmt::format("a tap will be full in about {:.3g} % of the pixels, the fullest with {:.3g} times "
                  "what it can hold: a shorter integration_time_s or a larger lens_f_number helps",
                  100.0 * findings.share_full, findings.fullest_over_well)};
}

} // namespace pmdsim
