// The terms that the sum leaves out for each light.

#include "engine/light/accumulate_pass.h"

#include "tests/support/scenes.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using test::cosine;

namespace {

Pattern table(const std::vector<double> &phi_rad) {
  const Diagram diagram{{0, 1}, phi_rad, std::vector<double>(2 * phi_rad.size(), 1.0)};
  return {Pattern::Kind::diagram, 0.0, std::make_shared<const Diagram>(diagram)};
}

// The model of two illuminators, each of which gets every pattern in turn.
SumModel model_of(const std::vector<Pattern> &patterns) {
  std::vector<CameraIlluminator> lights(2);
  for (std::size_t i = 0; i < 2 * patterns.size(); ++i)
    lights[i % 2].diodes.emplace_back().pattern = patterns[i / 2];
  return sum_model(lights, Backscatter::constant, true);
}

} // namespace

TEST_CASE("the sum knows the plainest pattern that serves all diodes") {
  const Pattern isotropic, axial = table({0}), other_axial = table({0}), around = table({0, 1});
  CHECK(model_of({isotropic}).pattern == shader::pattern_isotropic);
  for (const double order : {0.6, 3.0, 4.8, 20.0}) {
    CHECK(model_of({cosine(order)}).pattern == shader::pattern_power);
    CHECK(model_of({cosine(order)}).order == order);
  }
  for (const auto &patterns :
       {std::vector{cosine(100)}, {cosine(0)}, {cosine(2), cosine(3)}, {isotropic, cosine(3)}})
    CHECK(model_of(patterns).pattern == shader::pattern_general);
  CHECK(model_of({axial}).pattern == shader::pattern_axial);
  CHECK(model_of({axial, other_axial}).pattern == shader::pattern_axial);
  for (const auto &patterns : {std::vector{around}, {axial, around}, {isotropic, axial}, {axial, cosine(3)}})
    CHECK(model_of(patterns).pattern == shader::pattern_any);
}

TEST_CASE("the sum asks for surfaces only where they matter") {
  const std::vector<CameraIlluminator> lights{{{Diode{}}}};
  CHECK(sum_model(lights, Backscatter::constant, true).backscatter == shader::backscatter_flat);
  CHECK(sum_model(lights, Backscatter::constant, false).backscatter == shader::backscatter_facing);
  CHECK(sum_model(lights, Backscatter::lambert, true).backscatter == shader::backscatter_lambert);
}
