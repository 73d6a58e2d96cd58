#include "engine/passes/lit_windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace pmdsim {
namespace {

constexpr std::uint32_t window_diodes = shader::bundles_per_window * shader::diodes_per_bundle;

std::uint32_t bundles_for(std::uint32_t diodes) {
  return (diodes + shader::diodes_per_bundle - 1) / shader::diodes_per_bundle;
}

shader::DiodeBox around(std::span<const DiodePlace> places) {
  glm::dvec3 low_m(std::numeric_limits<double>::infinity()), high_m(-low_m);
  for (const DiodePlace &place : places) {
    low_m = glm::min(low_m, place.position_m);
    high_m = glm::max(high_m, place.position_m);
  }
  shader::DiodeBox box{};
  for (glm::length_t i = 0; i < 3; ++i) {
    box.low[i] = std::nextafter(static_cast<float>(low_m[i]), -std::numeric_limits<float>::infinity());
    box.high[i] = std::nextafter(static_cast<float>(high_m[i]), std::numeric_limits<float>::infinity());
  }
  return box;
}

void add_bundle(WindowDiodes &diodes, std::span<const DiodePlace> places) {
  const shader::DiodeBox box = around(places);
  const glm::vec3 centre(0.5f * (box.low + box.high));
  shader::BundleDiodes bundle{};
  glm::vec3 reach_m(0.0f);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < shader::diodes_per_bundle; ++i) {
    const DiodePlace &place = places[std::min(i, places.size() - 1)];
    const glm::vec3 from_centre_m(place.position_m - glm::dvec3(centre));
    bundle.places[i] = {from_centre_m, 0.0f};
    reach_m = glm::max(reach_m, glm::abs(from_centre_m));
    if (i < places.size() && place.number != no_id)
      bits |= 1u << i;
  }
  bundle.centre = {centre, reach_m.x + reach_m.y + reach_m.z};
  diodes.boxes.push_back(box);
  diodes.bundles.push_back(bundle);
  diodes.bits.push_back(bits);
}

} // namespace

LitWindow all_runs(const DiodeGroups &groups) {
  return {0, static_cast<std::uint32_t>(groups.runs.size()), 0,
          bundles_for(static_cast<std::uint32_t>(groups.diodes.size()))};
}

std::vector<LitWindow> plan_windows(const DiodeGroups &groups) {
  const std::uint32_t run_diodes = groups.blocks_per_run * shader::diodes_per_block;
  const std::uint32_t runs_per_window = std::max(1u, window_diodes / run_diodes);
  const auto runs = static_cast<std::uint32_t>(groups.runs.size());
  std::vector<LitWindow> windows;
  for (std::uint32_t first = 0; first < runs; first += runs_per_window) {
    const std::uint32_t last = std::min(runs, first + runs_per_window);
    windows.push_back({first, last, groups.runs[first].first, bundles_for((last - first) * run_diodes)});
  }
  return windows;
}

WindowDiodes diodes_of(const LitWindow &window, const DiodeGroups &groups) {
  const std::span<const DiodePlace> from = std::span(groups.places).subspan(window.first_diode);
  const auto of_window =
      from.first(std::min<std::size_t>(from.size(), std::size_t{window.last_run - window.first_run} *
                                                        groups.blocks_per_run * shader::diodes_per_block));
  WindowDiodes diodes;
  diodes.boxes.push_back(around(of_window));
  for (std::size_t i = 0; i < of_window.size(); i += shader::diodes_per_bundle)
    add_bundle(diodes,
               of_window.subspan(i, std::min<std::size_t>(shader::diodes_per_bundle, of_window.size() - i)));
  return diodes;
}

} // namespace pmdsim
