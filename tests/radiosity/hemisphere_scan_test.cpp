// What places see along lines: against shares known in closed form, against rays, and through cutouts.

#include "engine/surfaces/hemisphere_scan.h"

#include "engine/surfaces/facet_tree.h"
#include "engine/surfaces/surface_frame.h"
#include "tests/support/random_rooms.h"

#include <catch2/catch.hpp>
#include <functional>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

using VisitBin = std::function<void(const Facet &, const glm::dvec2 &weights, double length_m, double share)>;

// Calls visit for all that is seen of sides that reflect.
void for_each_seen(const HemisphereScan &scan, const Elements &elements, const SurfacePlace &place,
                   double turn, std::uint32_t lines, const VisitBin &visit) {
  scan.at(scan.frame(place, turn, lines), lines, [&](const SeenLine &line) {
    for (std::size_t i = 0; i < line.bins->count; ++i) {
      const auto face = static_cast<std::size_t>(line.face[i]);
      if (face < 2 * elements.facets.size() && elements.facets[face / 2].elements[face % 2] != no_element)
        visit(elements.facets[face / 2], {line.u[i], line.v[i]}, static_cast<double>(line.length_m[i]),
              static_cast<double>(line.share[i]));
    }
  });
}

double share_of_all(const HemisphereScan &scan, const Elements &elements, const SurfacePlace &place,
                    double turn, std::uint32_t lines) {
  double sum = 0.0;
  for_each_seen(scan, elements, place, turn, lines,
                [&](const Facet &, const glm::dvec2 &, double, double share) { sum += share; });
  return sum;
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
  const HemisphereScan scan(builder.scene(), elements, 192);
  double mean = 0.0;
  for (std::size_t i = 0; i < elements.elements.size(); ++i) {
    const double share = share_of_all(scan, elements, elements.elements[i].places[i % 4], turn_of(i), 12);
    CHECK(share == Approx(1.0).epsilon(1e-3));
    mean += share / static_cast<double>(elements.elements.size());
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
  const HemisphereScan scan(builder.scene(), elements, 192);
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  const double form = (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2.0 * std::numbers::pi);
  double mean = 0.0;
  for (std::size_t i = 0; i < 16; ++i) {
    const double share = share_of_all(scan, elements, {-elements.origin_m, {0, 0, 1}}, turn_of(i), 192);
    CHECK(share == Approx(form).epsilon(5e-3));
    mean += share / 16.0;
  }
  CHECK(mean == Approx(form).epsilon(3e-4));
}

TEST_CASE("lines see what rays see in random rooms with boxes, balls and meshes") {
  for (const std::uint32_t number : {2u, 5u, 6u}) {
    const Scene scene = random_room(number).scene;
    const Elements elements = make_elements(scene, 0.3);
    const FacetTree tree(scene, elements);
    const HemisphereScan scan(scene, elements, 192);
    for (std::size_t i = 0; i < 10; ++i) {
      // Fronts: inside of a box that stands on the floor, its bottom and the floor are equally near.
      const SurfacePlace place = places_of(elements.facets[i * elements.facets.size() / 10], 0)[3];
      std::vector<double> by_lines(scene.objects.size());
      for_each_seen(scan, elements, place, turn_of(i), 192,
                    [&](const Facet &facet, const glm::dvec2 &, double, double share) {
                      by_lines[scene.object_of(facet.triangle)] += share;
                    });
      const auto by_rays = shares_by_rays(scene, elements, tree, place);
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
  const HemisphereScan scan(builder.scene(), elements, 192);
  std::size_t seen = 0, outside = 0;
  const Triangle &triangle = builder.scene().triangles[0];
  const auto check = [&](const Facet &facet, const glm::dvec2 &weights, double length_m, double) {
    const CornerWeights at(1.0 - weights.x - weights.y, weights.x, weights.y);
    std::array<glm::dvec3, 3> corners_m;
    for (std::size_t k = 0; k < 3; ++k)
      corners_m[k] = builder.scene().positions_m[triangle.vertices[k]];
    CHECK(std::abs(glm::length(mixed(corners_m, at)) - length_m) < 1e-5);
    // In the facet, or in a cell that it shares with its neighbour.
    const glm::dmat3 triangle_from_facet(facet.in_triangle[0], facet.in_triangle[1], facet.in_triangle[2]);
    const glm::dvec3 in_facet = glm::inverse(triangle_from_facet) * at;
    const double inside = std::min({in_facet.x, in_facet.y, in_facet.z});
    CHECK(inside > -0.6);
    outside += inside < -1e-4 ? 1u : 0u;
    ++seen;
  };
  for_each_seen(scan, elements, {-elements.origin_m, {0, 0, 1}}, 0.2, 24, check);
  REQUIRE(seen > 2000);
  CHECK(outside < seen / 4);
}
