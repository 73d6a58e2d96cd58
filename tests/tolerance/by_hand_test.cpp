// Changes of distance that are known beforehand.

#include "tests/comparison/light_formula.h"
#include "tests/tolerance/views.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

const Tolerances defaults;

const ImageChange &of(const LinearTheory &theory, std::size_t diode, Fault fault) {
  return theory.diodes[diode].faults[static_cast<std::size_t>(fault)];
}

// A diode in the lens, a wall 2 m before it.
LitView one_diode() {
  const Sensor sensor = axial_sensor();
  return view_of(setup_of(wall_at(2.0), sensor, {diode_beside_lens(sensor, diode_at({0.0, 0.0, 0.0}))}), {0});
}

LitView ring_view(int count, const Sensor &sensor = axial_sensor()) {
  Illuminator light = light_at(ring(count, 0.1), 0.0, cosine(3.0));
  light.world_from_illuminator = sensor.world_from_camera;
  return view_of(setup_of(wall_at(2.0), sensor, {light}), all_pixels(sensor));
}

// c dphi / (4 pi f) of a degree at 20 MHz.
const double degree_m = speed_of_light_m_s * degree / (2.0 * full_turn_rad * 20e6);

} // namespace

TEST_CASE("a diode that moves towards the wall by dz makes the distance shorter by half of it") {
  const LitView view = one_diode();
  CHECK(slope_m(view, view.points[0], 0, Fault::z) == Approx(-0.5).epsilon(1e-12));
  const LinearTheory theory = linear_theory(view, defaults);
  CHECK(of(theory, 0, Fault::z).rms_m == Approx(0.5e-4).epsilon(1e-12));
  CHECK(of(theory, 0, Fault::z).varying_rms_m == 0.0); // a single pixel is its own offset
  for (const Fault fault : {Fault::x, Fault::y, Fault::axis_x, Fault::axis_y, Fault::intensity})
    CHECK(of(theory, 0, fault).rms_m < 1e-12);
  CHECK(of(theory, 0, Fault::phase).rms_m == Approx(degree_m).epsilon(1e-12));
}

TEST_CASE("without the only diode there is no distance, and that is told") {
  const LinearTheory theory = linear_theory(one_diode(), defaults);
  CHECK(std::isnan(of(theory, 0, Fault::dead).rms_m));
  CHECK(theory.diodes[0].left_dark == 1);
  CHECK(theory.board[static_cast<std::size_t>(Kind::dead)].rms_m == 0.0);
  CHECK(theory.diodes[0].light_share == 1.0);
}

TEST_CASE("on the axis of a ring intensities and dead diodes change nothing") {
  const LinearTheory theory = linear_theory(ring_view(12), defaults);
  for (std::size_t m = 0; m < 12; ++m) {
    CHECK(of(theory, m, Fault::intensity).rms_m < 1e-13);
    CHECK(of(theory, m, Fault::dead).rms_m < 1e-13);
    CHECK(of(theory, m, Fault::axis_x).rms_m < 1e-13);
    CHECK(of(theory, m, Fault::phase).rms_m == Approx(degree_m / 12.0).epsilon(1e-9));
    CHECK(theory.diodes[m].light_share == Approx(1.0 / 12.0));
  }
  // Independent errors of twelve diodes add up as squares.
  CHECK(theory.board[static_cast<std::size_t>(Kind::phase)].rms_m ==
        Approx(degree_m / std::sqrt(12.0)).epsilon(1e-9));
}

TEST_CASE("a phase that all diodes share moves every pixel alike, and is gone with the offset") {
  const LinearTheory theory = linear_theory(ring_view(7, wide_sensor()), defaults);
  const ImageChange &change = theory.alike[0][static_cast<std::size_t>(Fault::phase)];
  CHECK(change.rms_m == Approx(degree_m).epsilon(1e-12));
  CHECK(change.max_m == Approx(degree_m).epsilon(1e-12));
  CHECK(change.varying_rms_m < 1e-9); // the root of a difference of squares
  CHECK(change.varying_max_m < 1e-13);
  CHECK(theory.alike[0][static_cast<std::size_t>(Fault::intensity)].max_m < 1e-13);
}

TEST_CASE("even errors are smaller by the root of three than Gaussian ones of the same tolerance") {
  const LitView view = ring_view(7, wide_sensor());
  Tolerances even;
  even.law = ErrorLaw::uniform;
  const LinearTheory gaussian = linear_theory(view, defaults), uniform = linear_theory(view, even);
  for (const Kind kind : {Kind::position, Kind::axis, Kind::intensity, Kind::phase}) {
    const auto i = static_cast<std::size_t>(kind);
    CHECK(uniform.board[i].rms_m == Approx(gaussian.board[i].rms_m / std::sqrt(3.0)));
    CHECK(uniform.board[i].varying_rms_m == Approx(gaussian.board[i].varying_rms_m / std::sqrt(3.0)));
  }
  CHECK(uniform.board.back().rms_m < gaussian.board.back().rms_m);
}

TEST_CASE("the board's variance is that of its kinds, of its diodes, and the mean of the image's") {
  const LitView view = ring_view(12, wide_sensor());
  const LinearTheory theory = linear_theory(view, defaults);
  double of_kinds = 0.0, of_diodes = 0.0, of_image = 0.0, varying = 0.0;
  for (std::size_t i = 0; i < kind_count; ++i)
    of_kinds += std::pow(theory.board[i].rms_m, 2.0);
  for (const DiodeEffect &effect : theory.diodes)
    of_diodes += std::pow(effect.in_board.rms_m, 2.0);
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    of_image += std::pow(theory.deviation_m[i], 2.0) / static_cast<double>(view.points.size());
    varying += std::pow(theory.varying_deviation_m[i], 2.0) / static_cast<double>(view.points.size());
  }
  const double of_board = std::pow(theory.board.back().rms_m, 2.0);
  // Among dead ones a diode that lives counts for more; products of errors are small.
  const double of_dead = std::pow(theory.board[static_cast<std::size_t>(Kind::dead)].rms_m, 2.0);
  CHECK(of_dead + (of_kinds - of_dead) / (1.0 - defaults.dead) == Approx(of_board).epsilon(3e-3));
  CHECK(of_diodes == Approx(of_board));
  CHECK(of_image == Approx(of_board));
  CHECK(varying == Approx(std::pow(theory.board.back().varying_rms_m, 2.0)));
}

TEST_CASE("of few diodes every set of dead ones is a board of its own") {
  // Two on the axis of a wall, one 1 m farther back: a phase of a longer way by weights of 1/4 and 1/9.
  const Sensor sensor = axial_sensor();
  Illuminator light = diode_beside_lens(sensor, diode_at({0.0, 0.0, 0.0}));
  light.diodes.push_back(diode_at({0.0, 0.0, -1.0}));
  const LitView view = view_of(setup_of(wall_at(2.0), sensor, {light}), {0});
  Tolerances tolerances;
  tolerances.position_m = tolerances.axis_rad = tolerances.intensity = tolerances.phase_rad = 0.0;
  tolerances.dead = 0.25;
  const LinearTheory theory = linear_theory(view, tolerances);
  const std::complex<double> near = 1.0 / 4.0, far = std::polar(1.0 / 9.0, wavenumber_20mhz_rad_m);
  const double near_alone_m = metres_per_radian(view) * std::arg(near / (near + far)),
               far_alone_m = metres_per_radian(view) * std::arg(far / (near + far));
  // Both: 9/16, either alone: 3/16; neither is no distance. Over 15/16.
  const double mean_m = 0.2 * (near_alone_m + far_alone_m),
               square_m2 = 0.2 * (near_alone_m * near_alone_m + far_alone_m * far_alone_m);
  CHECK(theory.board[static_cast<std::size_t>(Kind::dead)].rms_m ==
        Approx(std::sqrt(square_m2 - mean_m * mean_m)).epsilon(1e-12));
  CHECK(theory.board.back().rms_m == theory.board[static_cast<std::size_t>(Kind::dead)].rms_m);
}
