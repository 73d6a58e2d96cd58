// The values that the diodes of a run share, as the shaders read them.

#include "engine/light/accumulate_pass.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;

namespace {

const std::vector<VisibleBox> point_at_2m{{{0.0, 0.0, 2.0}, {0.0, 0.0, 2.0}}};

SourceGroups pair_of(const Pattern &pattern, Precision precision) {
  CameraIlluminator light;
  for (const double x_m : {-0.3, 0.3}) {
    light.diodes.emplace_back().position_m = {x_m, 0.4, 0.0};
    light.diodes.back().pattern = pattern;
  }
  light.diodes[0].intensity_w_sr = 2.0;
  light.diodes[1].intensity_w_sr = 1.0;
  return group_diodes({light}, point_at_2m, 0.42, precision);
}

ErrorBound counting(double terms_per_weight_error, double terms_of_beam_edges = 0.0) {
  ErrorBound bound{};
  bound.terms_per_weight_error = terms_per_weight_error;
  bound.terms_of_beam_edges = terms_of_beam_edges;
  return bound;
}

const ErrorBound weights_of_100 = counting(100.0);

} // namespace

TEST_CASE("a run's intensity, and what heights and diagrams may be off by, as terms") {
  const auto table = std::make_shared<const Diagram>(Diagram{{0.0, 1.0}, {0.0}, {1.0, 0.5}});
  const Pattern measured{Pattern::Kind::diagram, 0.0, table};
  for (const auto &[precision, rounding] :
       {std::pair{Precision::fp32, 0x1p-24}, std::pair{Precision::fp64, 0x1p-45}}) {
    const SourceGroups groups = pair_of(measured, precision);
    const std::vector<shader::LightRun> runs = light_runs(groups, weights_of_100);
    REQUIRE(runs.size() == 1);
    CHECK(runs[0].intensity == 1.5f); // of 2, of which weights are parts
    // The reference point, 0.4 m from the lens, and 0.3 m to the diodes.
    CHECK(runs[0].heights == Approx(100.0 * 14 * rounding * 0.7));
    CHECK(runs[0].diagrams == Approx(100.0 * 1.5 * groups.positions[0].law_error));
    CHECK(light_runs(groups, ErrorBound{})[0].diagrams == 0.0f);
  }
  CHECK(light_runs(pair_of({}, Precision::fp32), weights_of_100)[0].diagrams == 0.0f);
}

TEST_CASE("what rounding does at the rims of a run's beams, as terms") {
  SourceGroups groups = pair_of({Pattern::Kind::cosine, 3.0}, Precision::fp32);
  const shader::LightRun alike = light_runs(groups, counting(0.0, 10.0))[0];
  CHECK(alike.beam_edges == 30.0f);
  CHECK(alike.beam_edge_root == Approx(1.0 / 3.0));
  CHECK(alike.beam_edge_most == Approx(10.0 * 3.0 * 0.5)); // 3 cos^2 at 45 degrees
  CHECK(light_runs(groups, ErrorBound{})[0].beam_edges == 0.0f);
  groups.diodes[0].order = 1.5f;
  const shader::LightRun mixed = light_runs(groups, counting(0.0, 10.0))[0];
  CHECK(mixed.beam_edges == 30.0f);
  CHECK(mixed.beam_edge_root == Approx(1.0 / 1.5));
}

TEST_CASE("what rims come to bounds what rounding of each diode's cosine does") {
  for (const auto &orders : {std::vector{3.0, 3.0}, std::vector{1.0, 8.0}, std::vector{40.0, 60.0}}) {
    SourceGroups groups = pair_of({Pattern::Kind::cosine, 3.0}, Precision::fp32);
    for (std::size_t i = 0; i < 2; ++i)
      groups.diodes[i].order = static_cast<float>(orders[i]);
    const shader::LightRun run = light_runs(groups, counting(0.0, 1.0))[0];
    for (const double first : {1e-6, 1e-3, 0.1, 0.7})
      for (const double second : {1e-6, 1e-3, 0.1, 0.7}) {
        const double of_first = std::pow(first, orders[0]), of_second = 0.5 * std::pow(second, orders[1]);
        const double weights = of_first + of_second;
        const double rounding = orders[0] * of_first / first + orders[1] * of_second / second;
        const double terms = static_cast<double>(run.beam_edges) * weights *
                             std::pow(weights / 1.5, -static_cast<double>(run.beam_edge_root));
        CHECK(rounding <= terms * 1.0001);
        CHECK(rounding <= static_cast<double>(run.beam_edge_most) * 1.5 * 1.0001);
      }
  }
}

TEST_CASE("what a run's beams come to bounds the squares of each diode's error") {
  SourceGroups groups = pair_of({Pattern::Kind::cosine, 100.0}, Precision::fp32);
  ErrorBound bound = counting(2.0);
  bound.beams = {50.0, 25.0};
  const shader::LightRun run = light_runs(groups, bound)[0];
  CHECK((run.beams == 200.0f && run.beams_per_log == 100.0f));
  for (const double first : {0.0, 1e-3, 0.3, 1.0, 7.0, 40.0})
    for (const double second : {0.0, 1e-3, 0.3, 1.0, 7.0, 40.0}) { // -ln J
      const double of_first = std::exp(-first), of_second = 0.5 * std::exp(-second);
      const double squares = 4.0 * (of_first * std::pow(bound.beams.at(first), 2.0) +
                                    of_second * std::pow(bound.beams.at(second), 2.0));
      const double weights = of_first + of_second, x = -std::log(weights / 1.5);
      CHECK(squares <= weights * x *
                               (static_cast<double>(run.beams) + static_cast<double>(run.beams_per_log) * x) *
                               1.0001 +
                           1e-12);
    }
}

TEST_CASE("beams that end as a step, or do not end, have no rim of their own") {
  // The largest n cos^(n - 1) down to cos = 10^-3, over n in (0, 1).
  double steepest = 0.0;
  for (double order = 0.001; order < 1.0; order += 0.001)
    steepest = std::max(steepest, order * std::pow(1e-3, order - 1.0));
  const auto rims = [](double order) {
    const Pattern pattern{Pattern::Kind::cosine, order};
    return static_cast<double>(
        light_runs(pair_of(pattern, Precision::fp32), counting(0.0, 1.0))[0].beam_edges);
  };
  CHECK(rims(0.0) == 0.0);
  CHECK(rims(0.5) >= steepest);
  CHECK(rims(0.5) <= 1.05 * steepest);
  CHECK(light_runs(pair_of({}, Precision::fp32), counting(0.0, 1.0))[0].beam_edges == 0.0f);
}
