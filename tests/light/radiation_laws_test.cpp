#include "engine/light/radiation_laws.h"

#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>

using namespace pmdsim;
using test::cosine;

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
const std::vector<VisibleBox> on_axis{{{0.0, 0.0, 2.0}, {0.0, 0.0, 2.0}}};
const std::vector<VisibleBox> at_60_degrees{{{0.0, 0.0, 1.0}, {std::sqrt(3.0), 0.0, 1.0}}};
const std::vector<VisibleBox> beside{{{1.0, 0.0, 0.0}, {1.0, 0.0, 2.0}}};

// Diodes in the lens that look along the optical axis.
std::vector<CameraIlluminator> light_of(const std::vector<Pattern> &patterns) {
  CameraIlluminator illuminator;
  for (const Pattern &pattern : patterns)
    illuminator.diodes.emplace_back().pattern = pattern;
  return {illuminator};
}

} // namespace

TEST_CASE("an isotropic diode has no slope, wherever it shines") {
  for (const auto &visible : {on_axis, at_60_degrees, beside})
    CHECK(pattern_slope(light_of({Pattern{}}), visible) == 0.0);
}

TEST_CASE("on its axis a cosine's power n is bent by n") {
  for (const double order : {0.5, 1.0, 12.0})
    CHECK(pattern_slope(light_of({cosine(order)}), on_axis) == Approx(std::sqrt(order)));
}

TEST_CASE("at an angle it falls by n times the tangent and is bent by n over the cosine squared") {
  CHECK(pattern_slope(light_of({cosine(9.0)}), at_60_degrees) == Approx(9.0 * std::sqrt(3.0)));
  CHECK(pattern_slope(light_of({cosine(0.25)}), at_60_degrees) == Approx(std::sqrt(0.25 * 4.0)));
}

TEST_CASE("the steepest of all diodes and of all that is visible counts") {
  auto light = light_of({Pattern{}, cosine(1.0), cosine(4.0)});
  const double steepest = pattern_slope(light_of({cosine(4.0)}), at_60_degrees);
  CHECK(pattern_slope(light, at_60_degrees) == steepest);
  CHECK(pattern_slope(light, {at_60_degrees[0], on_axis[0]}) == steepest);
  CHECK(pattern_slope({light_of({cosine(4.0)})[0], light_of({Pattern{}})[0]}, at_60_degrees) == steepest);
  light[0].diodes[2].axis = glm::dvec3(0.0, 0.0, -1.0); // all is behind it
  CHECK(pattern_slope(light, at_60_degrees) == unbounded);
}

TEST_CASE("a beam ends as an edge beside its diode") {
  for (const double order : {0.0, 1.0, 12.0}) {
    INFO("order " << order);
    CHECK(pattern_slope(light_of({cosine(order)}), beside) == unbounded);
    CHECK(pattern_slope(light_of({cosine(order), Pattern{}}), beside) == unbounded);
  }
}

TEST_CASE("a half-space of light is even") {
  CHECK(pattern_slope(light_of({cosine(0.0)}), at_60_degrees) == 0.0);
}

TEST_CASE("a measured diagram has edges") {
  const auto table = std::make_shared<const Diagram>(Diagram{{0.0, 1.0}, {0.0}, {1.0, 0.5}});
  CHECK(pattern_slope(light_of({{Pattern::Kind::diagram, 0.0, table}}), on_axis) == unbounded);
}

TEST_CASE("a record's number tells its law") {
  CHECK(law_of(Pattern{}).kind == Pattern::Kind::isotropic);
  for (const float order : {0.0f, 0.5f, 3.0f, 1e6f}) {
    shader::GroupSource diode{};
    diode.order = order;
    CHECK(law_of(diode).kind == Pattern::Kind::cosine);
  }
  for (const Pattern::Kind kind : {Pattern::Kind::isotropic, Pattern::Kind::diagram}) {
    shader::GroupSource diode{};
    diode.order = law_of(Pattern{kind}).number;
    CHECK(diode.order < 0.0f);
    CHECK(law_of(diode).kind == kind);
  }
}

TEST_CASE("measured diagrams have no series, and no bound where they vary about their axis") {
  const Pattern axial{Pattern::Kind::diagram, 0.0,
                      std::make_shared<const Diagram>(Diagram{{0.0, 1.0}, {0.0}, {1.0, 0.5}})};
  const Pattern any{Pattern::Kind::diagram, 0.0,
                    std::make_shared<const Diagram>(Diagram{{0.0, 1.0}, {0.0, 3.0}, {1.0, 0.9, 0.5, 0.4}})};
  DiagramTables tables;
  CHECK_FALSE(law_series(axial));
  CHECK(std::isfinite(law_error(axial, tables, 0.1)));
  CHECK_FALSE(std::isfinite(law_error(any, tables, 0.1)));
  CHECK(law_error(cosine(3.0), tables, 0.1) == 0.0);
  CHECK_FALSE(law_series(Pattern{}).value().order);
  CHECK(law_series(cosine(3.0)).value().order == 3.0);
}
