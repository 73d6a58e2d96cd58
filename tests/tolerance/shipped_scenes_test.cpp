// Linear theory against random boards over the shipped scenes at the default tolerances, with the table of
// docs/diodes.md.

#include "engine/tolerance/monte_carlo.h"
#include "tests/tolerance/views.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// `columns` x `columns` pixels spread over the image; those that no light returns from are left out.
LitView coarse_view(const Setup &setup, std::uint32_t columns) {
  const Sensor &sensor = setup.start.sensors[0];
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t i = 0; i < columns; ++i)
    for (std::uint32_t j = 0; j < columns; ++j)
      pixels.push_back((2 * i + 1) * sensor.resolution.y / (2 * columns) * sensor.resolution.x +
                       (2 * j + 1) * sensor.resolution.x / (2 * columns));
  LitView view = view_of(setup, pixels);
  const LinearTheory theory = linear_theory(view, {});
  std::vector<LitPoint> lit;
  for (std::size_t i = 0; i < view.points.size(); ++i)
    if (!std::isnan(theory.deviation_m[i]))
      lit.push_back(view.points[i]);
  view.points = lit;
  return view;
}

constexpr double nothing_m = 1e-9; // theory says that nothing changes

// Found over theory.
std::string ratio_text(double found, double theory, double standard_error) {
  if (theory < nothing_m)
    return fmt::format("{:>15}", "-");
  CHECK(standard_error < 0.0075);
  CHECK(found / theory == Approx(1.0).epsilon(0.02));
  return fmt::format("{:>8.4f} ±{:.4f}", found / theory, standard_error);
}

// From so many boards that the standard error is far below 2 %: where a single diode gives much of the light,
// few boards tell of its death.
BoardStatistics found_on_boards(const LitView &view, const Tolerances &tolerances, const KindsOn &on,
                                const Deviation &theory, double boards) {
  constexpr double wanted_error = 0.006, most_boards = 1e6;
  const auto of = [&](double count) {
    return board_statistics(board_changes(view, tolerances, on, static_cast<std::uint32_t>(count), 1));
  };
  const BoardStatistics first = of(boards);
  double error = theory.rms_m < nothing_m ? 0.0 : first.standard_error;
  if (theory.varying_rms_m > nothing_m)
    error = std::max(error, first.varying_standard_error);
  return error > wanted_error ? of(std::min(most_boards, 1.2 * boards * std::pow(error / wanted_error, 2.0)))
                              : first;
}

void compare(const std::string &scene, std::uint32_t columns, std::uint32_t boards,
             const Tolerances &tolerances = {}) {
  INFO(scene);
  const LitView view = coarse_view(load_setup(fmt::format("{}/{}.json", PMDSIM_SCENES, scene)), columns);
  REQUIRE(!view.points.empty());
  const LinearTheory theory = linear_theory(view, tolerances);
  std::string row = fmt::format("{:<30}{:>6}", scene, view.diodes.size()), varying_row;
  for (std::size_t kind = 0; kind <= kind_count; ++kind) {
    KindsOn on{};
    for (std::size_t i = 0; i < kind_count; ++i)
      on[i] = kind == kind_count || i == kind;
    const BoardStatistics found = found_on_boards(view, tolerances, on, theory.board[kind], boards);
    INFO("kind " << kind);
    row += ratio_text(found.rms_m, theory.board[kind].rms_m, found.standard_error);
    varying_row +=
        ratio_text(found.varying_rms_m, theory.board[kind].varying_rms_m, found.varying_standard_error);
  }
  fmt::print("{}\n{:<36}{}\n", row, "  at its offset", varying_row);
}

void print_heading(std::uint32_t boards) {
  fmt::print(
      "standard deviation of random boards over that of linear theory, {} boards and more\n{:<30}{:>6}",
      boards, "scene", "diodes");
  for (const char *name : kind_names)
    fmt::print("{:>15}", name);
  fmt::print("{:>15}\n", "all");
}

} // namespace

TEST_CASE("random boards have the deviations of linear theory within 2 %, in shipped scenes") {
  constexpr std::uint32_t boards = 20'000;
  print_heading(boards);
  for (const char *scene : {"penumbra", "signal", "electronics/kinect_v2_like"})
    compare(scene, 3, boards);
}

TEST_CASE("random boards have the deviations of linear theory within 2 %, in all shipped scenes", "[long]") {
  constexpr std::uint32_t boards = 20'000;
  print_heading(boards);
  for (const char *scene : {"paper_ring", "paper_half_ring", "bars", "room", "penumbra", "corner",
                            "closed_box", "light", "signal", "sensor", "motion", "electronics/kinect_v2_like",
                            "electronics/opt8241_like", "electronics/azure_kinect_like"})
    compare(scene, 4, boards);
}

// Its beams fall to a half at 3.4 degrees: a tilt of one degree is no small error, and few diodes light a
// point.
TEST_CASE("narrow beams have the deviations of linear theory within 2 % at a fifth of the tolerances",
          "[long]") {
  constexpr std::uint32_t boards = 20'000;
  constexpr double part = 0.2;
  Tolerances tolerances;
  tolerances.position_m *= part;
  tolerances.axis_rad *= part;
  tolerances.intensity *= part;
  tolerances.phase_rad *= part;
  tolerances.dead *= part;
  print_heading(boards);
  compare("paper_moire", 4, boards, tolerances);
}
