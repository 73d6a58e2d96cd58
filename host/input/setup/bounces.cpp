#include "host/input/file/length.h"
#include "host/input/setup/parts.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

constexpr double least_bounce_error_m = 1e-6, largest_bounce_error_m = 1.0;
constexpr std::size_t most_materials_named = 20;

double bounce_error_m(const std::string &text, const Place &place) {
  const std::optional<double> error_m = length_m(text);
  if (!error_m || *error_m < least_bounce_error_m || *error_m > largest_bounce_error_m)
    throw input_error(place, "expected a length from 1um to 1m with its unit, m, mm or um, e.g. 1mm, found " +
                                 in_quotes(text));
  return *error_m;
}

std::string materials_text(const std::vector<std::string> &materials) {
  const auto named = std::min(materials.size(), most_materials_named);
  const std::string others =
      named < materials.size() ? fmt::format(" and {} more", materials.size() - named) : "";
  return fmt::format(
      "only diffuse light bounces, so these materials are taken for Lambert surfaces: {}{}",
      fmt::join(materials.begin(), materials.begin() + static_cast<std::ptrdiff_t>(named), ", "), others);
}

} // namespace

Bounces bounces_of(const ordered_json &setup, const Place &root) {
  const ordered_json &count = setup.at("bounces");
  const Bounces bounces{count == "all" ? all_bounces : count.get<std::uint32_t>(),
                        bounce_error_m(setup.at("bounce_error"), root / "bounce_error")};
  if (bounces.any() && setup.at("backscatter") != "lambert")
    throw input_error(
        root / "backscatter",
        fmt::format("expected \"lambert\" where light bounces: of {} a surface may send back more "
                    "light than it gets",
                    setup.at("backscatter").dump()));
  return bounces;
}

std::vector<Warning> bounce_warnings(const Scene &scene, const GltfFile &gltf) {
  const Place place{gltf.file()};
  std::vector<Warning> warnings;
  if (!scene.discs.empty())
    warnings.push_back(input_warning(warning_code("points-without-bounces"), place,
                                     scene.triangles.empty()
                                         ? "the scene has points only, and nothing bounces off points"
                                         : "points neither reflect nor block light that bounces"));
  if (const std::vector<std::string> materials = gltf.materials_beyond_lambert(); !materials.empty())
    warnings.push_back(input_warning(warning_code("lambert-for-bounces"), place, materials_text(materials)));
  return warnings;
}

} // namespace pmdsim
