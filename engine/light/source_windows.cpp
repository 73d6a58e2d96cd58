#include "engine/light/source_windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace pmdsim {
namespace {

void add(shader::DiodeBox &box, const glm::dvec3 &position_m) {
  for (glm::length_t i = 0; i < 3; ++i) {
    const auto rounded = static_cast<float>(position_m[i]);
    box.low[i] = std::min(box.low[i], std::nextafter(rounded, -std::numeric_limits<float>::infinity()));
    box.high[i] = std::max(box.high[i], std::nextafter(rounded, std::numeric_limits<float>::infinity()));
  }
}

constexpr shader::DiodeBox empty_box{shader::vec4(std::numeric_limits<float>::max()),
                                     shader::vec4(std::numeric_limits<float>::lowest())};

void add_bundle(WindowDiodes &diodes, std::span<const SourcePosition> places) {
  shader::DiodeBox box = empty_box;
  for (const SourcePosition &place : places) {
    add(box, place.position_m);
    add(diodes.box, place.position_m);
  }
  const glm::vec3 centre(0.5f * (box.low + box.high));
  shader::BundleDiodes bundle{};
  glm::vec3 reach_m(0.0f);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < shader::diodes_per_bundle; ++i) {
    const SourcePosition &place = places[std::min(i, places.size() - 1)];
    const glm::vec3 from_centre_m(place.position_m - glm::dvec3(centre));
    const bool shines = i < places.size() && place.number != no_id;
    bundle.places[i] = {from_centre_m, shines ? 1.0f : 0.0f};
    reach_m = glm::max(reach_m, glm::abs(from_centre_m));
    if (shines)
      bits |= 1u << i;
  }
  bundle.extent = {reach_m, 0.0f};
  bundle.centre = {centre, reach_m.x + reach_m.y + reach_m.z};
  diodes.bundles.push_back(bundle);
  diodes.bits.push_back(bits);
}

} // namespace

std::uint32_t bundles_per_run(const SourceGroups &groups) {
  return (groups.blocks_per_run * shader::diodes_per_block - 1) / shader::diodes_per_bundle + 1;
}

SourceWindow all_runs(const SourceGroups &groups) {
  const auto runs = static_cast<std::uint32_t>(groups.runs.size());
  return {0, runs, runs * bundles_per_run(groups)};
}

std::vector<SourceWindow> plan_windows(const SourceGroups &groups, std::uint32_t most_bundles) {
  const std::uint32_t runs_per_window = std::max(1u, most_bundles / bundles_per_run(groups));
  const auto runs = static_cast<std::uint32_t>(groups.runs.size());
  std::vector<SourceWindow> windows;
  for (std::uint32_t first = 0; first < runs; first += runs_per_window) {
    const std::uint32_t last = std::min(runs, first + runs_per_window);
    windows.push_back({first, last, (last - first) * bundles_per_run(groups)});
  }
  return windows;
}

std::span<const SourcePosition> positions_of(const SourceWindow &window, std::uint32_t bundle,
                                             const SourceGroups &groups) {
  const std::uint32_t run = window.first_run + bundle / bundles_per_run(groups);
  const std::uint32_t within = bundle % bundles_per_run(groups) * shader::diodes_per_bundle;
  const std::uint32_t left = groups.blocks_per_run * shader::diodes_per_block - within;
  return std::span(groups.positions)
      .subspan(groups.runs[run].first + within, std::min(left, shader::diodes_per_bundle));
}

WindowDiodes diodes_of(const SourceWindow &window, const SourceGroups &groups) {
  WindowDiodes diodes{empty_box, {}, {}};
  for (std::uint32_t bundle = 0; bundle < window.bundles; ++bundle)
    add_bundle(diodes, positions_of(window, bundle, groups));
  return diodes;
}

} // namespace pmdsim
