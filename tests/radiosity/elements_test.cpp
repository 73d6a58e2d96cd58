// How surfaces are cut up, and the rules by which they are sampled.

#include "engine/surfaces/elements.h"
#include "engine/surfaces/grading.h"
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

TEST_CASE("elements that are cut cover what they covered, each half with its own") {
  SceneBuilder builder;
  builder.add_triangle({0, 0, 2}, {1, 0, 2}, {0, 1, 2.5}, {.reflectivity = 0.5, .double_sided = true});
  Elements elements = make_elements(builder.scene(), 0.9);
  const double area_m2 = area_of_elements(elements);
  const auto parts = split_elements(builder.scene(), elements, {0});
  CHECK(parts.size() == 4);
  CHECK(area_of_elements(elements) == Approx(area_m2));
  for (const std::uint32_t part : parts)
    for (std::size_t side = 0; side < 2; ++side) {
      const Element &element = elements.elements[elements.facets[part].elements[side]];
      CHECK(element.area_m2 == Approx(elements.facets[part].area_m2()));
      CHECK(glm::distance(element.places[3].position_m,
                          mixed(elements.facets[part].corners_m, piece_weights[3])) < 1e-12);
    }
}

TEST_CASE("an element that lies partly under a box is cut where the box begins") {
  SceneBuilder builder;
  const Surface surface{0.5};
  builder.add_triangle({-2, 0, 1}, {-2, 0, 5}, {2, 0, 1}, surface);
  builder.add_triangle({2, 0, 1}, {-2, 0, 5}, {2, 0, 5}, surface);
  builder.add_mesh(box_corners({-0.4, 0.0, 2.3}, {0.4, 0.7, 3.1}, 0.3), box_faces(false), surface);
  Elements elements = make_elements(builder.scene(), 0.5);
  const std::size_t before = elements.elements.size();
  const double area_m2 = area_of_elements(elements);
  const FacetTree tree(builder.scene(), elements);
  grade_elements(builder.scene(), tree, elements);
  CHECK(elements.elements.size() > before + 50);
  CHECK(elements.elements.size() < before + 2'000);
  CHECK(area_of_elements(elements) == Approx(area_m2));
  double smallest_m2 = area_m2;
  for (const Facet &facet : elements.facets)
    smallest_m2 = std::min(smallest_m2, facet.area_m2());
  CHECK(smallest_m2 < 0.125 / 1000.0); // five cuts leave 1/1024 of an element, two for being near 1/16
}
