#include "engine/light/radiation_laws.h"

#include "tests/support/scenes.h"

#include <array>
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

namespace {

shader::GroupSource diode_of_order(float order) {
  shader::GroupSource diode{};
  diode.order = order;
  return diode;
}

} // namespace

TEST_CASE("a narrow beam's error by -ln J is never below what it is by the cosine") {
  for (const float order : {9.0f, 30.0f, 192.5f, 400.0f, 1e5f})
    for (const double least_cosine : {0.71, 0.9, 0.999})
      for (const double t : {0.0, 0.1, 0.5}) {
        const std::array diodes{diode_of_order(order)};
        LawRounding sum{shader::pattern_general, t, least_cosine, true};
        const double apart = law_rounding_u(diodes, sum);
        const BeamError beams = beam_rounding(diodes, sum);
        CHECK(beams.square >= 2.0 * beams.square_per_log); // J times the square is concave in J
        sum.beams_are_apart = false;
        for (double part = 0.01; part <= 1.0; part += 0.01) {
          sum.least_cosine = 1.0 - part * (1.0 - least_cosine);
          const double dimming = -static_cast<double>(order) * std::log(sum.least_cosine);
          if (dimming > 87.0) // no float holds it
            break;
          INFO("order " << order << ", t " << t << ", cosine " << sum.least_cosine);
          REQUIRE(law_rounding_u(diodes, sum) <= 1.0001 * (apart + beams.at(dimming)));
        }
      }
}

TEST_CASE("only narrow beams' errors are apart, and each of their orders counts") {
  const std::vector<shader::GroupSource> mild{diode_of_order(2.0f), diode_of_order(-1.0f)},
      narrow{diode_of_order(100.0f)}, steep{diode_of_order(400.0f)},
      all{mild[0], mild[1], narrow[0], steep[0]};
  const LawRounding together{shader::pattern_general, 0.1, 0.8},
      apart{shader::pattern_general, 0.1, 0.8, true}, shared{shader::pattern_power, 0.1, 0.8, true};
  CHECK(beam_rounding(mild, apart).square == 0.0);
  CHECK(law_rounding_u(mild, apart) == law_rounding_u(mild, together));
  CHECK(law_rounding_u(all, apart) == law_rounding_u(mild, together));
  CHECK(beam_rounding(narrow, together).square == 0.0);
  CHECK(beam_rounding(narrow, shared).square == 0.0);
  CHECK(beam_rounding(steep, apart).square > 2.0 * beam_rounding(narrow, apart).square);
  CHECK(beam_rounding(all, apart).square == beam_rounding(steep, apart).square);
}
