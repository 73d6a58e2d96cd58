// What the diodes of a run share, as the shaders read it.

#include "engine/passes/accumulate.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

const std::vector<VisibleBox> point_at_2m{{{0.0, 0.0, 2.0}, {0.0, 0.0, 2.0}}};

DiodeGroups pair_of(const Pattern &pattern, Precision precision) {
  CameraIlluminator light;
  for (const double x_m : {-0.3, 0.3}) {
    light.diodes.emplace_back().position_m = {x_m, 0.4, 0.0};
    light.diodes.back().pattern = pattern;
  }
  light.diodes[0].intensity_w_sr = 2.0;
  light.diodes[1].intensity_w_sr = 1.0;
  return group_diodes({light}, point_at_2m, 0.42, precision);
}

} // namespace

TEST_CASE("a run's intensity, and what heights and diagrams may be off by, as terms") {
  const auto table = std::make_shared<const Diagram>(Diagram{{0.0, 1.0}, {0.0}, {1.0, 0.5}});
  const Pattern measured{Pattern::Kind::diagram, 0.0, table};
  for (const auto &[precision, rounding] :
       {std::pair{Precision::fp32, 0x1p-24}, std::pair{Precision::fp64, 0x1p-45}}) {
    const DiodeGroups groups = pair_of(measured, precision);
    const std::vector<shader::LightRun> runs = light_runs(groups, 100.0);
    REQUIRE(runs.size() == 1);
    CHECK(runs[0].intensity == 1.5f); // of 2, of which weights are parts
    // The reference point, 0.4 m from the lens, and 0.3 m to the diodes.
    CHECK(runs[0].heights == Approx(100.0 * 14 * rounding * 0.7));
    CHECK(runs[0].diagrams == Approx(100.0 * 1.5 * groups.places[0].diagram_error));
    CHECK(light_runs(groups, 0.0)[0].diagrams == 0.0f);
  }
  CHECK(light_runs(pair_of({}, Precision::fp32), 100.0)[0].diagrams == 0.0f);
}
