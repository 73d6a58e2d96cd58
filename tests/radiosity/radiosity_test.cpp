// What holds for light that bounces whatever the scene: it is neither made nor lost, and takes its ways back.

#include "engine/model/error.h"
#include "engine/radiosity/exchange.h"
#include "engine/radiosity/krylov.h"
#include "engine/radiosity/radiosity.h"
#include "tests/support/random_rooms.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Scene closed_box(double reflectivity) {
  SceneBuilder builder;
  builder.add_mesh(box_corners({0.1, 0.0, 1.0}, {1.0, 0.7, 1.4}, 0.0), box_faces(true), {reflectivity});
  return builder.scene();
}

const std::vector<BounceTone> slow{{.hz = 1e3, .harmonic = 1, .frequency = 0, .relative = 1.0}};

Illuminator lamp() { return {"lamp", node_from_camera(), {diode_at({0.3, 0.1, 0.5})}}; }

} // namespace

TEST_CASE("in a closed box all that a lamp sends out is absorbed in the end") {
  for (const double reflectivity : {0.3, 0.8}) {
    const Radiosity solved =
        solve_radiosity(closed_box(reflectivity), {lamp()}, Shadows::automatic, {all_bounces}, slow,
                        {.element_m = 0.25, .lines = 16, .bins = 192, .facet_part = 2e-5});
    double absorbed_w = 0.0;
    for (std::size_t i = 0; i < solved.elements.facets.size(); ++i) {
      const FaceLight &light = solved.exitance.of(2 * i, 0);
      const Facet &facet = solved.elements.facets[i];
      const CornerWeights centre = (facet.in_triangle[0] + facet.in_triangle[1] + facet.in_triangle[2]) / 3.0;
      const Phasor mean = light_at(light.leaving, static_cast<float>(centre.y), static_cast<float>(centre.z));
      absorbed_w += static_cast<double>(abs(mean)) / reflectivity * (1.0 - reflectivity) * facet.area_m2();
    }
    CHECK(absorbed_w == Approx(4.0 * std::numbers::pi).epsilon(1e-3)); // of 1 W/sr all around
  }
}

TEST_CASE("what one wall sends to another is what the other sends to it") {
  const Scene scene = random_room(3).scene;
  const Elements elements = make_elements(scene, 0.15);
  const HemisphereScan scan(scene, elements, 192);
  const ElementLight layout(elements);
  const std::vector<BounceTone> tone{{.hz = 20e6, .harmonic = 1, .frequency = 0, .relative = 1.0}};
  const auto object_of = [&](const Facet &facet) { return scene.object_of(facet.triangle); };
  // What arrives on each object, W, of light that leaves the fronts of one, 1 W/m^2 everywhere.
  const auto sent = [&](std::uint32_t from) {
    Exitance faces(elements.facets.size(), 1);
    for (std::size_t i = 0; i < elements.facets.size(); ++i)
      if (object_of(elements.facets[i]) == from)
        faces.of(2 * i, 0).leaving.at = {1.0f, 0.0f};
    const Exchange exchange(elements, layout, scan, 16, tone, faces);
    const std::vector<Phasor> &values = exchange.first(0);
    std::vector<Phasor> arrived(scene.objects.size());
    for (const Facet &facet : elements.facets) {
      if (facet.whole) // of a mesh, which is not asked about
        continue;
      const std::size_t first = layout.first_value(facet.elements[0], 0);
      const Phasor mean = (1.0f / 3.0f) * (values[first] + values[first + 1] + values[first + 2]);
      arrived[object_of(facet)] += static_cast<float>(facet.area_m2()) * mean;
    }
    return arrived;
  };
  constexpr std::uint32_t walls = 5; // the first objects, whose backs reflect nothing
  std::vector<std::vector<Phasor>> by_wall;
  for (std::uint32_t wall = 0; wall < walls; ++wall)
    by_wall.push_back(sent(wall));
  for (std::uint32_t a = 0; a < walls; ++a)
    for (std::uint32_t b = 0; b < a; ++b) {
      CAPTURE(a, b);
      CHECK(abs(by_wall[a][b]) > 0.1f);
      CHECK(abs(by_wall[a][b] - by_wall[b][a]) < 5e-3f * abs(by_wall[a][b]));
    }
}

TEST_CASE("light that nothing absorbs and that cannot leave is refused") {
  const auto solve = [](double reflectivity, std::uint32_t bounces) {
    return solve_radiosity(closed_box(reflectivity), {lamp()}, Shadows::automatic, {bounces}, slow,
                           {.element_m = 0.4, .lines = 8, .bins = 128, .facet_part = 1e-3});
  };
  CHECK_THROWS_AS(solve(1.0, all_bounces), Error);
  CHECK_NOTHROW(solve(1.0, 3));
  CHECK_NOTHROW(solve(0.995, all_bounces));
}

TEST_CASE("the series that an iteration sums is that of its product") {
  Random random(7);
  std::vector<std::vector<Phasor>> matrix(12, std::vector<Phasor>(12));
  std::vector<Phasor> b(12);
  for (std::size_t i = 0; i < 12; ++i) {
    b[i] = {static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-1, 1))};
    for (Phasor &value : matrix[i])
      value = {static_cast<float>(random.uniform(-0.1, 0.1)), static_cast<float>(random.uniform(-0.1, 0.1))};
  }
  const auto product = [&](const std::vector<Phasor> &x) {
    std::vector<Phasor> y(12);
    for (std::size_t i = 0; i < 12; ++i)
      for (std::size_t k = 0; k < 12; ++k)
        y[i] += matrix[i][k] * x[k];
    return y;
  };
  const KrylovSolution solution = solve_series(b, product, 1e-6, 40);
  const std::vector<Phasor> again = product(solution.x);
  for (std::size_t i = 0; i < 12; ++i)
    CHECK(abs(solution.x[i] - b[i] - again[i]) < 1e-5f);
  CHECK(solution.products <= 12);
}
