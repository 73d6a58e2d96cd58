// What the diodes of a run share, as the shaders read it.

#include "engine/passes/accumulate.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

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

Promise counting(double terms_per_weight_error, double terms_of_rims = 0.0) {
  Promise promise{};
  promise.terms_per_weight_error = terms_per_weight_error;
  promise.terms_of_rims = terms_of_rims;
  return promise;
}

const Promise weights_of_100 = counting(100.0);

} // namespace

TEST_CASE("a run's intensity, and what heights and diagrams may be off by, as terms") {
  const auto table = std::make_shared<const Diagram>(Diagram{{0.0, 1.0}, {0.0}, {1.0, 0.5}});
  const Pattern measured{Pattern::Kind::diagram, 0.0, table};
  for (const auto &[precision, rounding] :
       {std::pair{Precision::fp32, 0x1p-24}, std::pair{Precision::fp64, 0x1p-45}}) {
    const DiodeGroups groups = pair_of(measured, precision);
    const std::vector<shader::LightRun> runs = light_runs(groups, weights_of_100);
    REQUIRE(runs.size() == 1);
    CHECK(runs[0].intensity == 1.5f); // of 2, of which weights are parts
    // The reference point, 0.4 m from the lens, and 0.3 m to the diodes.
    CHECK(runs[0].heights == Approx(100.0 * 14 * rounding * 0.7));
    CHECK(runs[0].diagrams == Approx(100.0 * 1.5 * groups.places[0].diagram_error));
    CHECK(light_runs(groups, Promise{})[0].diagrams == 0.0f);
  }
  CHECK(light_runs(pair_of({}, Precision::fp32), weights_of_100)[0].diagrams == 0.0f);
}

TEST_CASE("what rounding does at the rims of a run's beams, as terms") {
  // Heights along the axes: -0.3 and 0.3 m of the diodes' middle, times the axes' x.
  DiodeGroups groups = pair_of({Pattern::Kind::cosine, 3.0}, Precision::fp32);
  const shader::LightRun straight = light_runs(groups, counting(0.0, 10.0))[0];
  CHECK(straight.rims == 30.0f);
  CHECK(straight.rim_power == 2.0f);
  CHECK(straight.axis == glm::vec4(0, 0, 1, 0)); // of the dark ones that pad the run nothing
  CHECK(straight.heights_m == glm::vec2(0.0f));
  CHECK(light_runs(groups, Promise{})[0].rims == 0.0f);

  groups.diodes[0].axis = {0.6f, 0.0f, 0.8f, 0.2f};
  groups.diodes[0].order = 1.5f;
  const shader::LightRun mixed = light_runs(groups, counting(0.0, 10.0))[0];
  CHECK(mixed.rims == 30.0f);
  CHECK(mixed.rim_power == 0.5f);
  CHECK(mixed.axis.x == Approx(0.3));
  CHECK(mixed.axis.z == Approx(0.9));
  CHECK(mixed.axis.w == Approx(std::hypot(0.3, 0.1)));
  CHECK(mixed.heights_m == glm::vec2(0.1f));
}

TEST_CASE("beams that end as a step, or do not end, have no rim of their own") {
  // Of n cos^(n - 1) down to cos = 10^-3 the largest over n in (0, 1).
  double steepest = 0.0;
  for (double order = 0.001; order < 1.0; order += 0.001)
    steepest = std::max(steepest, order * std::pow(1e-3, order - 1.0));
  const auto rims = [](double order) {
    const Pattern pattern{Pattern::Kind::cosine, order};
    return static_cast<double>(light_runs(pair_of(pattern, Precision::fp32), counting(0.0, 1.0))[0].rims);
  };
  CHECK(rims(0.0) == 0.0);
  CHECK(rims(0.5) >= steepest);
  CHECK(rims(0.5) <= 1.05 * steepest);
  CHECK(light_runs(pair_of({}, Precision::fp32), counting(0.0, 1.0))[0].rims == 0.0f);
}
