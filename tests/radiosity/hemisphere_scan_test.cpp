// What places see along lines: against shares known in closed form, against rays, and through cutouts.

#include "engine/surfaces/hemisphere_scan.h"

#include "engine/surfaces/facet_tree.h"
#include "engine/surfaces/surface_frame.h"
#include "tests/support/random_rooms.h"

#include <catch2/catch.hpp>
#include <numeric>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

double sum_of(const std::vector<float> &values) { return std::accumulate(values.begin(), values.end(), 0.0); }

// The shares of the objects of a scene, seen along lines.
std::vector<double> shares_of(const Scene &scene, const Elements &elements, const Sightings &seen) {
  std::vector<double> shares(scene.objects.size());
  for (std::size_t i = 0; i < seen.face.size(); ++i)
    shares[scene.object_of(elements.facets[seen.face[i] / 2].triangle)] += static_cast<double>(seen.share[i]);
  return shares;
}

// The same by rays.
std::vector<double> shares_by_rays(const Scene &scene, const Elements &elements, const FacetTree &tree,
                                   const SurfacePlace &place) {
  constexpr std::size_t rays = std::size_t{1} << 15;
  const SurfaceFrame frame(place, 0.0);
  std::vector<double> shares(scene.objects.size());
  for (std::size_t first = 0; first < rays; first += packet_rays) {
    RayPacket packet;
    for (std::size_t i = 0; i < packet_rays; ++i) {
      const double number = static_cast<double>(first + i), part = (number + 0.5) / rays,
                   angle = 2.0 * std::numbers::pi * std::numbers::phi * number;
      packet.directions[i] =
          glm::vec3(std::sqrt(part) * (std::cos(angle) * frame.x + std::sin(angle) * frame.y) +
                    std::sqrt(1.0 - part) * frame.z);
    }
    tree.trace(place.position_m + elements.clearance_m() * place.normal, packet);
    for (std::size_t i = 0; i < packet_rays; ++i)
      if (packet.facet[i] != no_facet &&
          elements.facets[packet.facet[i]].elements[packet.side[i]] != no_element)
        shares[scene.object_of(elements.facets[packet.facet[i]].triangle)] += 1.0 / rays;
  }
  return shares;
}

} // namespace

TEST_CASE("shares of a closed box sum to one, at any place of it") {
  SceneBuilder builder;
  builder.add_mesh(box_corners({0.1, 0.0, 1.0}, {1.0, 0.7, 1.4}, 0.0), box_faces(true), {0.5});
  const Elements elements = make_elements(builder.scene(), 0.2);
  const HemisphereScan scan(builder.scene(), elements);
  Sightings seen;
  double mean = 0.0;
  for (std::size_t i = 0; i < elements.elements.size(); ++i) {
    scan.at(elements.elements[i].places[i % 4], turn_of(i), 12, seen);
    CHECK(sum_of(seen.share) == Approx(1.0).epsilon(1e-3));
    mean += sum_of(seen.share) / static_cast<double>(elements.elements.size());
  }
  CHECK(mean == Approx(1.0).epsilon(1e-4));
}

// The form factor from a place to a rectangle above it, one of whose corners is right over it.
TEST_CASE("the share of a rectangle is its form factor") {
  SceneBuilder builder{Pose{}};
  const double a = 0.8, b = 0.5, c = 0.6;
  builder.add_triangle({0, 0, c}, {0, b, c}, {a, 0, c}, {0.5}); // its front looks down
  builder.add_triangle({a, b, c}, {a, 0, c}, {0, b, c}, {0.5});
  const Elements elements = make_elements(builder.scene(), 0.3);
  const HemisphereScan scan(builder.scene(), elements);
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  const double form = (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2.0 * std::numbers::pi);
  Sightings seen;
  double mean = 0.0;
  for (std::size_t i = 0; i < 16; ++i) {
    scan.at({-elements.origin_m, {0, 0, 1}}, turn_of(i), 64, seen);
    CHECK(sum_of(seen.share) == Approx(form).epsilon(5e-3));
    mean += sum_of(seen.share) / 16.0;
  }
  CHECK(mean == Approx(form).epsilon(3e-4));
}

TEST_CASE("lines see what rays see in random rooms with boxes, balls and meshes") {
  for (const std::uint32_t number : {2u, 5u, 6u}) {
    const Scene scene = random_room(number).scene;
    const Elements elements = make_elements(scene, 0.3);
    const FacetTree tree(scene, elements);
    const HemisphereScan scan(scene, elements);
    Sightings seen;
    for (std::size_t i = 0; i < 10; ++i) {
      // Fronts: inside of a box that stands on the floor, its bottom and the floor are equally near.
      const SurfacePlace place = places_of(elements.facets[i * elements.facets.size() / 10], 0)[3];
      scan.at(place, turn_of(i), 192, seen);
      const auto by_lines = shares_of(scene, elements, seen),
                 by_rays = shares_by_rays(scene, elements, tree, place);
      for (std::size_t object = 0; object < by_rays.size(); ++object) {
        CAPTURE(number, i, object, by_lines[object], by_rays[object]);
        CHECK(std::abs(by_lines[object] - by_rays[object]) < 3e-3);
      }
    }
  }
}

TEST_CASE("sightings of a plane have its distances, in the facets that lie there") {
  SceneBuilder builder{Pose{}};
  builder.add_triangle({-3, -3, 1}, {-3, 4, 1}, {5, -2, 1}, {0.5});
  Elements elements = make_elements(builder.scene(), 0.7);
  split_facets(builder.scene(), elements, {1, 7, 12});
  const HemisphereScan scan(builder.scene(), elements);
  Sightings seen;
  scan.at({-elements.origin_m, {0, 0, 1}}, 0.2, 24, seen);
  REQUIRE(seen.face.size() > 500);
  double off_m = 0.0;
  for (std::size_t i = 0; i < seen.face.size(); ++i) {
    const Facet &facet = elements.facets[seen.face[i] / 2];
    const double u = static_cast<double>(seen.u[i]), v = static_cast<double>(seen.v[i]);
    CHECK(std::min({u, v, 1.0 - u - v}) > -1e-3);
    const glm::dvec3 place = mixed(facet.corners_m, {1.0 - u - v, u, v}) + elements.origin_m;
    off_m = std::max(off_m, std::abs(glm::length(place) - static_cast<double>(seen.length_m[i])));
  }
  CHECK(off_m < 0.01); // the length is a mean over the part of the line
}
