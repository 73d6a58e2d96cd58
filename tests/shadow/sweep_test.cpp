// The sweep of the light's place from the lens to the diodes, over boards of every kind, against the
// reference.

#include "engine/shadow/boards.h"
#include "tests/comparison/visibility_comparison.h"
#include "tests/shadow/boards.h"
#include "tests/support/random_cameras.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Places bar(std::size_t count) {
  Places places_m;
  for (std::size_t i = 0; i < count; ++i)
    places_m.emplace_back(-0.15 + 0.3 * static_cast<double>(i) / static_cast<double>(count - 1), 0.0, 0.0);
  return places_m;
}

// On a part of a sphere about a place in front of the lens.
Places dome(std::size_t count) {
  Places places_m = rings(0.0, count);
  for (glm::dvec3 &place_m : places_m)
    place_m.z = 1.0 - std::sqrt(1.0 - place_m.x * place_m.x - place_m.y * place_m.y);
  return places_m;
}

struct BoardCase {
  std::string name;
  std::vector<Places> boards;
};

std::vector<BoardCase> board_cases() {
  return {{"around the lens", {rings(0.0, 48)}},
          {"5 mm behind the lens", {rings(-0.005, 48)}},
          {"20 mm before the lens", {rings(0.02, 48)}},
          {"tilted", {moved(rings(0.0, 48), tilt(0.4), {})}},
          {"tilted and beside the lens", {moved(rings(0.0, 48), tilt(-0.5), {0.4, 0.1, -0.02})}},
          {"far beside the lens", {moved(rings(0.0, 48), glm::dmat3(1.0), {1.5, 0.0, 0.0})}},
          {"two boards",
           {moved(rings(0.0, 24), glm::dmat3(1.0), {-0.3, 0.0, 0.0}),
            moved(rings(0.0, 24), tilt(0.3), {0.3, 0.0, 0.0})}},
          {"boards in turn", {rings(0.0, 300), moved(rings(0.0, 300), tilt(0.3), {}), rings(0.0, 300)}},
          {"a bar through the lens", {bar(40)}},
          {"one diode in the lens", {{glm::dvec3(0.0)}}},
          {"one diode beside it", {{glm::dvec3(0.05, 0.02, 0.0)}}},
          {"a dome", {dome(48)}},
          {"more diodes than a window has", {rings(0.0, 600)}}};
}

// The camera and the scene that all boards are tried on.
struct BoardScene {
  Sensor sensor;
  Scene scene;
};

BoardScene board_scene(std::uint32_t seed, std::uint32_t pixels) {
  const Sensor sensor = tumbled_camera(seed, pixels);
  Random random(seed + 1);
  return {sensor, random_triangles(random, 300, sensor.world_from_camera)};
}

Measurement measure(const BoardScene &on, const std::vector<Illuminator> &illuminators, bool on_host,
                    std::uint32_t host_vector_bits = 512) {
  Simulator simulator = make_simulator({.device = {},
                                        .keep_sample_ids = true,
                                        .keep_visibility = true,
                                        .host_vector_bits = host_vector_bits,
                                        .allowed = {.host_sweep = on_host}});
  simulator.prepare(on.scene, on.sensor, illuminators, Backscatter::lambert, Shadows::automatic);
  return simulator.measure();
}

void check_boards(std::uint32_t seed, std::uint32_t pixels) {
  fmt::print("{}", reached_heading());
  const BoardScene on = board_scene(seed, pixels);
  for (const BoardCase &board_case : board_cases()) {
    INFO(board_case.name);
    const auto illuminators = illuminators_of(board_case.boards, on.sensor);
    const auto expected = reference::simulate(on.scene, on.sensor, illuminators, Backscatter::lambert,
                                              {Shadows::automatic, true});
    for (const bool on_host : {true, false}) {
      const ReachedComparison reached =
          compare_reached(measure(on, illuminators, on_host), expected, on.scene, on.sensor, illuminators);
      fmt::print("{}", reached_row(board_case.name + (on_host ? ", host" : ", device"), reached));
      CHECK(reached.clear_of_all == 0);
      CHECK(reached.differing_fraction() <= 1e-4);
      CHECK(reached.lit_error <= 1e-6);
      CHECK(reached.pairs > 0);
      CHECK(reached.reached < reached.pairs);
    }
  }
}

Board board_of(const Places &places_m) {
  CameraIlluminator light;
  for (const glm::dvec3 &place_m : places_m) {
    Diode diode;
    diode.position_m = place_m;
    light.diodes.push_back(diode);
  }
  VisibleBox box;
  box.add({-1.0, -1.0, 1.0});
  box.add({1.0, 1.0, 3.0});
  const SourceGroups groups = group_diodes({light}, {box}, 0.4);
  const std::vector<SourceWindow> windows = plan_windows(groups);
  const std::vector<Board> boards = find_boards(groups, windows);
  REQUIRE(boards.size() == 1);
  return boards.front();
}

} // namespace

TEST_CASE("every kind of board agrees with the reference", "[smoke]") { check_boards(41, 24); }

TEST_CASE("every kind of board agrees with the reference, more samples", "[long]") {
  for (std::uint32_t seed = 42; seed < 46; ++seed)
    check_boards(seed, 96);
}

TEST_CASE("a window is swept in parts, plane by plane") {
  const auto light_of = [](double x_m, double z_m, int diodes) {
    CameraIlluminator light;
    for (int i = 0; i < diodes; ++i) {
      Diode diode;
      diode.position_m = {x_m + 1e-3 * (i % 20), 1e-3 * (i / 20), z_m};
      light.diodes.push_back(diode);
    }
    return light;
  };
  VisibleBox box;
  box.add({-1.0, -1.0, 1.0});
  box.add({1.0, 1.0, 3.0});
  // Two boards in one plane, whose runs come together, a board behind them, and one of too many diodes.
  const SourceGroups groups = group_diodes(
      {light_of(-0.2, 0.0, 60), light_of(0.2, 0.0, 60), light_of(0.0, -0.1, 60), light_of(0.0, 0.2, 700)},
      {box}, 0.4);
  const auto windows = plan_windows(groups, bundles_per_host_window);
  REQUIRE(windows.size() == 1);
  std::uint32_t next_run = 0, next_bundle = 0;
  std::vector<SourceWindow> swept;
  for (const WindowPart &part : parts_of(windows[0], groups)) {
    CHECK(part.runs.first_run == next_run);
    CHECK(part.first_bundle == next_bundle);
    CHECK(part.runs.bundles <= shader::bundles_per_window);
    next_run = part.runs.last_run;
    next_bundle += part.runs.bundles;
    swept.push_back(part.runs);
  }
  CHECK(next_run == groups.runs.size());
  CHECK(next_bundle == windows[0].bundles);
  const std::vector<Board> boards = find_boards(groups, swept);
  CHECK(boards.size() == 3);
  CHECK(std::ranges::all_of(boards, &Board::is_flat));
}

TEST_CASE("vectors of every width leave the same bits") {
  const BoardScene on = board_scene(47, 24);
  const std::vector<BoardCase> cases = board_cases();
  for (std::size_t i = 2; i < cases.size(); i += 3) {
    const BoardCase &board_case = cases[i];
    INFO(board_case.name);
    const auto illuminators = illuminators_of(board_case.boards, on.sensor);
    const Measurement widest = measure(on, illuminators, true);
    for (const std::uint32_t bits : {256u, 128u})
      CHECK(measure(on, illuminators, true, bits).sample_visibility == widest.sample_visibility);
  }
}

TEST_CASE("a wall between lens and diodes shades all that the lens sees") {
  const Sensor sensor = axial_sensor({24, 24});
  SceneBuilder builder;
  builder.add_wall({2.0});
  // The whole plane x = 0.5 m, as far as anybody looks; none of its edges is near any way.
  builder.add_triangle({0.5, -50.0, 50.0}, {0.5, -50.0, -50.0}, {0.5, 100.0, 0.0}, {0.5, true});
  const BoardCase beyond{"beyond the wall", {moved(rings(0.0, 48), glm::dmat3(1.0), {1.0, 0.0, 0.0})}};
  const auto illuminators = illuminators_of(beyond.boards, sensor);
  Simulator simulator = make_simulator({.device = {}, .keep_sample_ids = true, .keep_visibility = true});
  simulator.prepare(builder.scene(), sensor, illuminators, Backscatter::lambert, Shadows::automatic);
  const Measurement measured = simulator.measure();
  CHECK(std::ranges::all_of(measured.lit, [](float lit) { return lit == 0.0f; }));
  CHECK(std::ranges::all_of(measured.coverage, [](float coverage) { return coverage == 1.0f; }));
}

TEST_CASE("a board's frame has its diodes in one plane and the lens over its origin") {
  for (const Places &places_m :
       {rings(0.0, 48), rings(0.02, 48), moved(rings(0.0, 48), tilt(0.4), {0.3, -0.2, 0.01}), bar(5)}) {
    const Board board = board_of(places_m);
    CHECK(board.is_flat);
    for (const glm::dvec3 &place_m : places_m) {
      CHECK(std::abs(board.in_frame(place_m).z) < 1e-12);
      CHECK(std::hypot(board.in_frame(place_m).x, board.in_frame(place_m).y) <=
            board.radius_m * (1.0 + 1e-12));
    }
    const glm::dvec3 lens_m = board.in_frame(glm::dvec3(0.0));
    CHECK(glm::distance(lens_m, glm::dvec3(0.0, 0.0, board.lens_z_m)) < 1e-12);
    CHECK(board.in_frame({0.0, 0.0, 5.0}).z < 0.0);
  }
  CHECK_FALSE(board_of(dome(48)).is_flat);
}
