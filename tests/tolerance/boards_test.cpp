// Random boards: what their errors are, that they are the same again, and that z is summed as it should be.

#include "engine/tolerance/board_work.h"
#include "engine/tolerance/monte_carlo.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/random_diagrams.h"
#include "tests/tolerance/views.h"

#include <catch2/catch.hpp>
#include <tbb/task_arena.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr KindsOn all_kinds{true, true, true, true, true};

KindsOn only(Kind kind) {
  KindsOn on{};
  on[static_cast<std::size_t>(kind)] = true;
  return on;
}

LitView small_view(const std::vector<Pattern> &patterns, const Waveform &waveform = {},
                   Backscatter backscatter = Backscatter::lambert) {
  Sensor sensor = wide_sensor();
  sensor.waveform = waveform;
  Illuminator light = light_at(ring(11, 0.12), 0.3);
  for (std::size_t m = 0; m < light.diodes.size(); ++m)
    light.diodes[m].pattern = patterns[m % patterns.size()];
  light.world_from_illuminator = sensor.world_from_camera;
  const auto last = static_cast<std::uint32_t>(sensor.pixel_count() - 1);
  return view_of(setup_of(wall_at(1.5, {.reflectivity = 0.6}), sensor, {light}, backscatter),
                 {0, last / 2 + 7, last});
}

TolerancedDiode straight_diode() { return toleranced(diode_at({0.0, 0.0, 0.0}), 0.0, 0, glm::dmat3(1.0)); }

struct Moment {
  double sum = 0.0, squares = 0.0;
  void add(double value) {
    sum += value;
    squares += value * value;
  }
};

} // namespace

TEST_CASE("errors have the tolerances' deviations and no mean") {
  for (const ErrorLaw law : {ErrorLaw::gaussian, ErrorLaw::uniform}) {
    Tolerances tolerances;
    tolerances.law = law;
    constexpr std::uint32_t count = 40'000;
    std::array<Moment, 7> moments;
    double dead = 0.0, most = 0.0;
    KindsOn on = all_kinds;
    for (std::uint32_t board = 0; board < count; ++board) {
      on[static_cast<std::size_t>(Kind::dead)] = false;
      const TolerancedDiode of = on_board(straight_diode(), tolerances, on, 5, board, 3);
      const std::array errors{of.diode.position_m.x / tolerances.position_m,
                              of.diode.position_m.y / tolerances.position_m,
                              of.diode.position_m.z / tolerances.position_m,
                              of.diode.axis.x / tolerances.axis_rad,
                              of.diode.axis.y / tolerances.axis_rad,
                              (of.diode.intensity_w_sr - 1.0) / tolerances.intensity,
                              of.phase_turns * radians_per_turn / tolerances.phase_rad};
      for (std::size_t i = 0; i < errors.size(); ++i) {
        moments[i].add(errors[i]);
        most = std::max(most, std::abs(errors[i]));
      }
      on[static_cast<std::size_t>(Kind::dead)] = true;
      dead += on_board(straight_diode(), tolerances, on, 5, board, 3).diode.intensity_w_sr == 0.0 ? 1.0 : 0.0;
    }
    const double variance = law == ErrorLaw::uniform ? 1.0 / 3.0 : 1.0;
    for (const Moment &of : moments) {
      CHECK(std::abs(of.sum / count) < 5.0 * std::sqrt(variance / count));
      CHECK(of.squares / count == Approx(variance).epsilon(0.03));
    }
    CHECK((law == ErrorLaw::uniform ? most <= 1.0 : most > 3.5));
    CHECK(std::abs(dead / count - 0.01) < 5.0 * std::sqrt(0.01 / count));
  }
}

TEST_CASE("a tilt turns the axis by its angle and keeps the diagram's zero at right angles") {
  Tolerances tolerances;
  tolerances.axis_rad = 0.3;
  const TolerancedDiode of = on_board(straight_diode(), tolerances, only(Kind::axis), 1, 2, 3);
  CHECK(glm::length(of.diode.axis) == Approx(1.0).epsilon(1e-14));
  CHECK(glm::length(of.diode.across) == Approx(1.0).epsilon(1e-14));
  CHECK(std::abs(glm::dot(of.diode.axis, of.diode.across)) < 1e-14);
  CHECK(of.diode.axis.z < 1.0 - 1e-6);
}

TEST_CASE("a kind's errors are the same whatever else is on, and no kind is on by itself") {
  const TolerancedDiode alone = on_board(straight_diode(), {}, only(Kind::phase), 9, 7, 1),
                        together = on_board(straight_diode(), {}, all_kinds, 9, 7, 1),
                        none = on_board(straight_diode(), {}, {}, 9, 7, 1);
  CHECK(alone.phase_turns == together.phase_turns);
  CHECK(alone.phase_turns != 0.0);
  CHECK(alone.diode == straight_diode().diode);
  CHECK(together.diode.position_m != none.diode.position_m);
  CHECK((none.diode == straight_diode().diode && none.phase_turns == 0.0));
}

TEST_CASE("the same seed gives the same bits with one thread and with several, another seed others") {
  const LitView view = small_view({cosine(3.0)});
  const auto changes_by = [&](int threads, std::uint64_t seed) {
    BoardChanges changes;
    tbb::task_arena(threads).execute([&] { changes = board_changes(view, {}, all_kinds, 500, seed); });
    return changes.change_m;
  };
  const std::vector<double> one = changes_by(1, 4);
  CHECK(one == changes_by(2, 4));
  CHECK(one != changes_by(1, 5));
  CHECK(one != changes_by(1, 4 + (std::uint64_t{1} << 32)));
  const auto theory_by = [&](int threads) {
    LinearTheory theory;
    tbb::task_arena(threads).execute([&] { theory = linear_theory(view, {}); });
    return theory;
  };
  CHECK(theory_by(1).deviation_m == theory_by(2).deviation_m);
  CHECK(theory_by(1).board.back().rms_m == theory_by(2).board.back().rms_m);
}

TEST_CASE("boards are summed as their diodes' terms are, for all waves and laws") {
  Random random(3);
  const Pattern diagram{Pattern::Kind::diagram, 0.0, random_diagram(random, false)};
  const std::vector<std::vector<Pattern>> laws{
      {Pattern{}}, {cosine(0.0)}, {cosine(3.0)}, {cosine(2.5)}, {cosine(1.0), Pattern{}, diagram}};
  const std::vector<Waveform> waves{
      {}, {Waveform::Kind::square, {}}, {Waveform::Kind::harmonics, {1.0, 0.0, 0.2}}};
  for (const auto &patterns : laws)
    for (const Waveform &wave : waves)
      for (const Backscatter backscatter : {Backscatter::lambert, Backscatter::constant}) {
        const LitView view = small_view(patterns, wave, backscatter);
        const BoardChanges changes = board_changes(view, {}, all_kinds, 3, 11);
        for (std::uint32_t board = 0; board < 3; ++board) {
          std::vector<TolerancedDiode> diodes;
          for (std::uint32_t m = 0; m < view.diodes.size(); ++m)
            diodes.push_back(on_board(view.diodes[m], {}, all_kinds, 11, board, m));
          for (std::size_t i = 0; i < view.points.size(); ++i) {
            const double expected_m =
                metres_per_radian(view) *
                std::arg(z_of(view, view.points[i], diodes) / z_of(view, view.points[i], view.diodes));
            CHECK(std::abs(changes.at(board, i) - expected_m) < 1e-12);
          }
        }
      }
}

TEST_CASE("the loops of every instruction set sum alike") {
  Random random(8);
  constexpr std::size_t count = 24;
  std::array<std::vector<double>, 9> arrays;
  for (std::size_t a = 0; a < arrays.size(); ++a)
    for (std::size_t i = 0; i < count; ++i)
      arrays[a].push_back(a < 3    ? random.uniform(-0.2, 0.2)
                          : a == 8 ? (i % 5 > 0)
                                   : random.uniform(0.1, 0.9));
  BoardWork board{count,
                  arrays[0].data(),
                  arrays[1].data(),
                  arrays[2].data(),
                  arrays[3].data(),
                  arrays[4].data(),
                  arrays[5].data(),
                  arrays[6].data(),
                  arrays[7].data(),
                  false,
                  5,
                  nullptr,
                  0.07};
  const PointWork point{0.3, 0.2, 2.0, 0.0, 0.0, -1.0, 0.4, true, 2.1, arrays[8].data()};
  double re = 0.0, im = 0.0;
  widest_board_loops(128).sum(board, point, re, im);
  CHECK(std::hypot(re, im) > 0.01);
  for (const std::uint32_t bits : {256u, 512u}) {
    double wide_re = 0.0, wide_im = 0.0;
    widest_board_loops(bits).sum(board, point, wide_re, wide_im);
    CHECK(std::abs(wide_re - re) < 1e-13);
    CHECK(std::abs(wide_im - im) < 1e-13);
  }
}

TEST_CASE("a board without a diode that lives has no distance, and counts for nothing") {
  const Sensor sensor = axial_sensor();
  const LitView view =
      view_of(setup_of(wall_at(2.0), sensor, {diode_beside_lens(sensor, diode_at({0.0, 0.0, 0.0}))}), {0});
  Tolerances tolerances;
  tolerances.dead = 0.5;
  const BoardChanges changes = board_changes(view, tolerances, only(Kind::dead), 400, 0);
  const auto dark = std::ranges::count_if(changes.change_m, [](double change) { return std::isnan(change); });
  CHECK(dark > 150);
  CHECK(dark < 250);
  const BoardStatistics statistics = board_statistics(changes);
  CHECK(statistics.rms_m == 0.0);
  CHECK(statistics.most_rms_m == 0.0);
}

TEST_CASE("a point of weight 3 counts as three points, in theory and on boards") {
  for (const std::size_t diodes :
       {std::size_t{11}, std::size_t{5}}) { // few diodes have a theory of their own
    LitView weighted = small_view({cosine(3.0), cosine(1.0)});
    weighted.diodes.resize(diodes);
    LitView repeated = weighted;
    weighted.points[1].weight = 3.0;
    repeated.points.insert(repeated.points.end(), 2, repeated.points[1]);
    const LinearTheory of_weights = linear_theory(weighted, {}), of_points = linear_theory(repeated, {});
    for (std::size_t kind = 0; kind <= kind_count; ++kind) {
      CHECK(of_weights.board[kind].rms_m == Approx(of_points.board[kind].rms_m).epsilon(1e-9));
      CHECK(of_weights.board[kind].varying_rms_m ==
            Approx(of_points.board[kind].varying_rms_m).epsilon(1e-9));
    }
    for (std::size_t m = 0; m < diodes; ++m)
      CHECK(of_weights.diodes[m].light_share == Approx(of_points.diodes[m].light_share).epsilon(1e-9));
    const auto on_boards = [](const LitView &view) {
      return board_statistics(board_changes(view, {}, all_kinds, 300, 9));
    };
    const BoardStatistics by_weights = on_boards(weighted), by_points = on_boards(repeated);
    CHECK(by_weights.rms_m == Approx(by_points.rms_m).epsilon(1e-9));
    CHECK(by_weights.varying_rms_m == Approx(by_points.varying_rms_m).epsilon(1e-9));
    CHECK(by_weights.most_rms_m == Approx(by_points.most_rms_m).epsilon(1e-9));
    CHECK(by_weights.most_varying_rms_m == Approx(by_points.most_varying_rms_m).epsilon(1e-9));
    CHECK(by_weights.standard_error == Approx(by_points.standard_error).epsilon(1e-9));
  }
}
