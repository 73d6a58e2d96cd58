// How surfaces are cut up, and the rules by which they are sampled.

#include "engine/radiosity/elements.h"
#include "engine/radiosity/exitance.h"
#include "engine/radiosity/hemisphere.h"
#include "tests/support/random_rooms.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

double area_of_facets(const Elements &elements) {
  double area_m2 = 0.0;
  for (const Facet &facet : elements.facets)
    area_m2 += facet.area_m2();
  return area_m2;
}

// Of single-sided surfaces.
double area_of_elements(const Elements &elements) {
  double area_m2 = 0.0;
  for (const Element &element : elements.elements)
    area_m2 += element.area_m2;
  return area_m2;
}

} // namespace

TEST_CASE("elements cover the surfaces, and facets go on doing so when they are cut") {
  const Scene scene = random_room(1).scene;
  Elements elements = make_elements(scene, 0.2);
  const double reflecting_m2 = reflecting_area_m2(scene), facets_m2 = area_of_facets(elements);
  CHECK(area_of_elements(elements) == Approx(reflecting_m2));
  for (const Element &element : elements.elements)
    CHECK(element.area_m2 <= 0.5 * 0.2 * 0.2 * 4.0); // groups are at most a cube's face of each direction
  split_facets(scene, elements, {0, 5, 9});
  CHECK(area_of_facets(elements) == Approx(facets_m2));
}

TEST_CASE("a fine mesh becomes few elements") {
  SceneBuilder builder;
  add_ball(builder, {0, 0, 2}, 0.5, 100, {0.5});
  const Elements elements = make_elements(builder.scene(), 0.2);
  CHECK(elements.facets.size() == builder.scene().triangles.size());
  CHECK(elements.facets.size() > 30'000);
  CHECK(elements.elements.size() < 600);
  CHECK(area_of_elements(elements) == Approx(reflecting_area_m2(builder.scene())));
}

TEST_CASE("the Gauss points of an element give a linear function at the corners of its facets") {
  SceneBuilder builder;
  builder.add_triangle({0, 0, 2}, {1, 0, 2}, {0, 1, 2.5}, {0.5});
  Elements elements = make_elements(builder.scene(), 0.9);
  split_facets(builder.scene(), elements, {0});
  const auto value = [](const glm::dvec3 &p) { return 1.0 + 2.0 * p.x - 3.0 * p.y + 0.5 * p.z; };
  for (const Facet &facet : elements.facets)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto &places = elements.elements[facet.elements[0]].places;
      double sum = 0.0;
      for (glm::length_t k = 0; k < 3; ++k)
        sum += static_cast<double>(facet.in_element[corner][k]) *
               value(places[static_cast<std::size_t>(k)].position_m);
      CHECK(sum == Approx(value(facet.corners_m[corner])).margin(1e-6));
    }
}

TEST_CASE("what a linear function misses of a curved one is nothing at Gauss points and in the mean") {
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(std::abs(missed_part(static_cast<float>(piece_weights[i].y),
                               static_cast<float>(piece_weights[i].z))) < 1e-6f);
  CHECK(missed_part(1.0f / 3.0f, 1.0f / 3.0f) == Approx(1.0f));
  double sum = 0.0;
  constexpr int n = 100;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n - i; ++j)
      for (int down = 0; down < (i + j < n - 1 ? 2 : 1); ++down) {
        const double third = down == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
        sum += static_cast<double>(
            missed_part(static_cast<float>((i + third) / n), static_cast<float>((j + third) / n)));
      }
  CHECK(std::abs(sum) / (n * n) < 1e-3);
}

TEST_CASE("directions over a hemisphere stand for equal shares of what arrives") {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
  constexpr std::uint32_t n = 64;
  const Hemisphere hemisphere(normal, 0.37, n);
  glm::dvec3 mean(0.0);
  double heights = 0.0, squares = 0.0;
  for (std::uint32_t row = 0; row < n; ++row)
    for (std::uint32_t column = 0; column < n; ++column) {
      const glm::dvec3 direction(hemisphere.direction({column, row}));
      CHECK(std::abs(glm::length(direction) - 1.0) < 1e-6);
      const double height = glm::dot(direction, normal);
      mean += direction / static_cast<double>(n * n);
      heights += height / (n * n);
      squares += height * height / (n * n);
    }
  CHECK(heights == Approx(2.0 / 3.0).epsilon(1e-6)); // the integral of cos^2 over that of cos
  CHECK(squares == Approx(0.5).epsilon(1e-3));
  CHECK(glm::length(mean - heights * normal) < 1e-6);
}
