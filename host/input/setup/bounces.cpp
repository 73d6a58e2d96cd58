#include "host/input/file/length.h"
#include "host/input/setup/parts.h"

#include <algorithm>
#include <fmt/format.h>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

constexpr double least_bounce_error_m = 1e-6, largest_bounce_error_m = 1.0;

double bounce_error_m(const std::string &text, const Place &place) {
  const std::optional<double> error_m = length_m(text);
  if (!error_m || *error_m < least_bounce_error_m || *error_m > largest_bounce_error_m)
    throw input_error(place, "expected a length from 1um to 1m with its unit, m, mm or um, e.g. 1mm, found " +
                                 in_quotes(text));
  return *error_m;
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
  return warnings;
}

} // namespace pmdsim
