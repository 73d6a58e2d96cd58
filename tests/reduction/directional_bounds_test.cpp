#include "engine/reduction/directional_bounds.h"

#include <catch2/catch.hpp>
#include <random>

using namespace pmdsim;

TEST_CASE("pieces cover their boxes, and directions bound every point of them") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  const auto somewhere = [&] { return glm::dvec3(place(random), place(random), place(random)); };
  for (int repetition = 0; repetition < 100; ++repetition) {
    const glm::dvec3 from_m = 0.1 * somewhere(), beam = glm::normalize(somewhere() + glm::dvec3(0, 0, 2));
    const glm::dvec3 across = glm::normalize(glm::cross(beam, somewhere()));
    const glm::dmat3 axes{across, glm::cross(beam, across), beam};
    const glm::dvec3 centre_m = std::exp2(4.0 * place(random)) * (somewhere() + glm::dvec3(0, 0, 1.5));
    const glm::dvec3 half_m = 2.0 * glm::abs(somewhere());
    const VisibleBox box{centre_m - half_m, centre_m + half_m};
    const auto pieces = pieces_of({box}, {from_m - 0.1, from_m + 0.1});
    const auto directions = directional_bounds(pieces, from_m, axes, beam);
    for (int i = 0; i < 50; ++i) {
      const glm::dvec3 point_m = glm::mix(box.low_m, box.high_m, 0.5 + 0.5 * somewhere());
      const glm::dvec3 p = point_m - from_m;
      const double range_m = glm::length(p), rounding = 1e-12;
      CHECK(std::ranges::any_of(pieces, [&](const VisibleBox &piece) {
        return glm::clamp(point_m, piece.low_m, piece.high_m) == point_m;
      }));
      CHECK(std::ranges::any_of(directions, [&](const DirectionalBounds &direction) {
        const glm::dvec3 along = glm::transpose(axes) * p / range_m;
        return direction.range_m <= range_m &&
               glm::dot(beam, p) >= (direction.beam_cosine - rounding) * range_m &&
               glm::all(glm::lessThanEqual(direction.least - rounding, along)) &&
               glm::all(glm::lessThanEqual(along, direction.largest + rounding));
      }));
    }
  }
}

TEST_CASE("distances between boxes") {
  const VisibleBox a{glm::dvec3(0.0), glm::dvec3(1.0)}, b{{4.0, 0.5, -3.0}, {5.0, 0.75, -3.0}};
  CHECK(least_distance_m(a, b) == Approx(std::sqrt(9.0 + 9.0)));
  CHECK(largest_distance_m(a, b) == Approx(std::sqrt(25.0 + 0.75 * 0.75 + 16.0)));
  CHECK(least_distance_m(a, a) == 0.0);
}
