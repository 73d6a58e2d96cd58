#include "engine/error_budget/plan.h"

#include "engine/model/error.h"
#include "engine/view/projection.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// The paper's ring before a wall that fills the view.
struct PlannedSetup {
  Scene scene = wall_at(2.0);
  Sensor sensor;
  std::vector<Illuminator> lights;
  bool on_host = true;

  PlannedSetup() {
    sensor.resolution = {64, 64};
    sensor.pixel_pitch_m = glm::dvec2(450e-6);
    lights.push_back({"ring", sensor.world_from_camera, {}});
    for (const double radius_m : {0.126, 0.136, 0.146, 0.156, 0.166})
      for (int i = 0; i < 48; ++i) {
        const double turn_rad = 2.0 * std::numbers::pi * i / 48;
        lights[0].diodes.push_back(
            diode_at({radius_m * std::cos(turn_rad), radius_m * std::sin(turn_rad), 0.0}));
      }
  }
};

FramePlan plan(const PlannedSetup &setup, const Accuracy &accuracy, std::uint32_t attempt = 0) {
  const CameraScene camera = to_camera(setup.scene, setup.sensor);
  const auto lights = to_camera(setup.lights, setup.sensor);
  const Projection projection = project(camera, chip_blocks(setup.sensor, 8192));
  const Modulation signal = modulation_of(setup.sensor, {});
  const SumModel model = sum_model(lights, Backscatter::constant, all_face_the_light(camera, lights));
  return plan_frame(
      {lights, projection.visible, setup.sensor, signal, model, Backscatter::constant, setup.on_host},
      accuracy, attempt);
}

Accuracy automatic(double max_error_m) {
  Accuracy accuracy;
  accuracy.mode = Mode::automatic;
  accuracy.max_error_m = max_error_m;
  return accuracy;
}

std::size_t shining(const SourceGroups &groups) {
  return static_cast<std::size_t>(std::ranges::count_if(
      groups.positions, [](const SourcePosition &place) { return place.number != no_id; }));
}

void check_refused(const PlannedSetup &setup, const Accuracy &accuracy) {
  for (std::uint32_t attempt = 0; attempt < frame_plans; ++attempt) {
    INFO("attempt " << attempt);
    try {
      plan(setup, accuracy, attempt);
      FAIL("a plan was made");
    } catch (const Error &error) {
      CHECK(error.code() == ExitCode::accuracy);
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
}

} // namespace

TEST_CASE("mode exact sums all diodes in float and promises nothing, but claims what theory knows") {
  const FramePlan exact = plan({}, {});
  CHECK_FALSE(exact.bound);
  CHECK_FALSE(exact.bound_of_all);
  CHECK_FALSE(exact.is_reduced());
  CHECK(shining(exact.reduced) == 240);
  CHECK(exact.precision == Precision::fp32);
  REQUIRE(exact.claimed_m);
  CHECK(*exact.claimed_m > 0.0);
  CHECK(*exact.claimed_m < 1e-6);
  REQUIRE(exact.claimed_amplitude);
  CHECK(*exact.claimed_amplitude < 1e-5);
}

TEST_CASE("mode exact with adaptive samples promises the error that they may cost") {
  PlannedSetup setup;
  setup.sensor.samples = 4;
  setup.sensor.adaptive_samples = true;
  const FramePlan exact = plan(setup, {});
  REQUIRE(exact.bound);
  REQUIRE(exact.bound_of_all);
  CHECK(exact.bound->limit_m == default_max_error_m);
  CHECK_FALSE(exact.is_reduced());
}

TEST_CASE("the ring within a micrometre takes few diodes in float and surely keeps what it claims") {
  const FramePlan few = plan({}, automatic(1e-6));
  CHECK(few.precision == Precision::fp32);
  CHECK(shining(few.all) == 240);
  CHECK(shining(few.reduced) < 24);
  CHECK(few.is_reduced());
  CHECK(few.surely_kept);
  REQUIRE(few.bound);
  CHECK(few.bound->limit_m == 1e-6);
  REQUIRE(few.claimed_m);
  CHECK(*few.claimed_m <= 1e-6);
  CHECK(*few.claimed_m > 0.0);
}

TEST_CASE("of many diodes those that are alike stand in long runs") {
  PlannedSetup many;
  const std::vector<Diode> ring = many.lights[0].diodes;
  for (const double z_m : {-0.01, -0.02})
    for (Diode diode : ring) {
      diode.position_m.z = z_m;
      many.lights[0].diodes.push_back(diode);
    }
  const FramePlan alike = plan(many, {});
  CHECK(alike.all.polynomials.equal_weights);
  CHECK(alike.all.runs.size() == 1);
  CHECK(alike.all.blocks_per_run == 45);
  CHECK(alike.all.polynomials.tables.size() == 1);
  many.on_host = false;
  const FramePlan short_runs = plan(many, {});
  CHECK(short_runs.all.polynomials.equal_weights);
  CHECK(short_runs.all.blocks_per_run == 15);
  REQUIRE((alike.claimed_m && short_runs.claimed_m));
  CHECK(*alike.claimed_m < 1.05 * *short_runs.claimed_m); // the rounding of long runs is hardly worse
  many.on_host = true;
  many.lights[0].diodes[3].intensity_w_sr = 0.5;
  const FramePlan unequal = plan(many, {});
  CHECK_FALSE(unequal.all.polynomials.equal_weights);
  CHECK(unequal.all.blocks_per_run == 15);
}

TEST_CASE("stand-ins shine as much as all diodes do") {
  const auto light_of = [](const SourceGroups &groups) {
    double sum_w_sr = 0.0;
    for (const shader::GroupSource &diode : groups.diodes)
      sum_w_sr += groups.largest_intensity_w_sr * double{diode.intensity};
    return sum_w_sr;
  };
  const FramePlan few = plan({}, automatic(1e-6));
  CHECK(light_of(few.reduced) == Approx(light_of(few.all)).epsilon(1e-5));
}

TEST_CASE("more error, fewer diodes") {
  std::size_t before = 240;
  for (const double max_error_m : {1e-6, 1e-4, 1e-2}) {
    const std::size_t now = shining(plan({}, automatic(max_error_m)).reduced);
    CHECK(now <= before);
    before = now;
  }
  CHECK(before < shining(plan({}, automatic(1e-6)).reduced));
}

TEST_CASE("what a float cannot hold is refused, and so is what theory cannot bound") {
  check_refused({}, automatic(1e-9)); // 2 m is rounded by up to 120 nm
  Accuracy amplitude = automatic(1e-3);
  amplitude.max_amplitude_error = 1e-12;
  check_refused({}, amplitude);
  PlannedSetup measured;
  const auto table = std::make_shared<const Diagram>(
      Diagram{{0.0, 1.0}, {0.0, std::numbers::pi}, {1.0, 0.9, 0.5, 0.4}}); // varies about its own axis
  measured.lights[0].diodes[7].pattern = {Pattern::Kind::diagram, 0.0, table};
  check_refused(measured, automatic(1e-3));
  CHECK_FALSE(plan(measured, {}).claimed_m);
}

TEST_CASE("each plan is more exact than the one before, the last one has every diode in double") {
  double before_m = 1.0;
  std::size_t diodes = 0;
  for (std::uint32_t attempt = 0; attempt < frame_plans; ++attempt) {
    INFO("attempt " << attempt);
    const FramePlan now = plan({}, automatic(1e-6), attempt);
    REQUIRE(now.bound);
    CHECK(now.bound->per_condition_m < before_m);
    CHECK(shining(now.reduced) >= diodes);
    CHECK((now.precision == Precision::fp64) == (attempt > 0));
    before_m = now.bound->per_condition_m;
    diodes = shining(now.reduced);
  }
  CHECK(diodes == 240);
}

TEST_CASE("lamps of different phases are reduced, and summed in float, where few pixels' returns cancel") {
  PlannedSetup phased;
  phased.lights.push_back(phased.lights[0]);
  const auto plan_of = [&](double phase_rad, double max_error_m = 3e-6) {
    phased.lights[1].modulation_phase_rad = phase_rad;
    return plan(phased, automatic(max_error_m));
  };
  const FramePlan apart = plan_of(0.5);
  CHECK(apart.precision == Precision::fp32);
  CHECK(shining(apart.reduced) < shining(apart.all));
  CHECK(plan_of(3.1).precision == Precision::fp64);
  phased.sensor.modulation_hz = {2e6}; // at which their bound is wide
  CHECK(plan_of(0.2, 3e-5).precision == Precision::fp64);
}

TEST_CASE("tables stand for roots where the error asked for leaves room") {
  PlannedSetup beams;
  for (Diode &diode : beams.lights[0].diodes)
    diode.pattern = {Pattern::Kind::cosine, 20.0, nullptr};
  CHECK(plan(beams, automatic(1e-4)).all.near_polynomials);
  CHECK_FALSE(plan(beams, automatic(1e-6)).all.near_polynomials);
  CHECK(plan(beams, {}).all.near_polynomials); // which an exact frame's claim contains
  beams.sensor.samples = 2;
  CHECK_FALSE(plan(beams, automatic(1e-4)).all.near_polynomials);
  PlannedSetup narrow;
  for (Diode &diode : narrow.lights[0].diodes)
    diode.pattern = cosine(40.0); // taken by exponentials, and by tables beside them
  CHECK_FALSE(plan(narrow, automatic(1e-4)).all.near_polynomials);
  CHECK(plan(narrow, {}).all.near_polynomials);
}

TEST_CASE("tables end where rounding would grow beyond the error asked for") {
  PlannedSetup wide;
  for (Diode &diode : wide.lights[0].diodes) {
    diode.position_m *= 4.3;
    diode.pattern = cosine(9.0);
  }
  wide.scene = wall_at(1.5);
  const FramePlan by_tables = plan(wide, automatic(1e-4)), by_roots = plan(wide, automatic(1e-5));
  REQUIRE(by_tables.all.near_polynomials);
  CHECK(by_tables.all.near_polynomials->growth > 1.9);
  CHECK(by_tables.all.near_polynomials->growth <= largest_near_growth);
  const FramePlan between = plan(wide, automatic(1.6e-5));
  REQUIRE(between.all.near_polynomials);
  CHECK(between.all.near_polynomials->growth < 0.95 * by_tables.all.near_polynomials->growth);
  CHECK(between.all.near_polynomials->growth > 1.4);
  CHECK_FALSE(by_roots.all.near_polynomials);
  CHECK(by_roots.precision == Precision::fp32);
}

TEST_CASE("a precision that was asked for is taken") {
  Accuracy accuracy = automatic(1e-6);
  accuracy.precision = Precision::fp64;
  CHECK(plan({}, accuracy).precision == Precision::fp64);
  accuracy.precision = Precision::fp32;
  for (std::uint32_t attempt = 0; attempt < frame_plans; ++attempt)
    CHECK(plan({}, accuracy, attempt).precision == Precision::fp32);
}

TEST_CASE("where returns may cancel, every pixel is watched and nothing is claimed beforehand") {
  PlannedSetup phased;
  phased.lights.push_back(phased.lights[0]);
  phased.lights[1].modulation_phase_rad = 3.0;
  PlannedSetup sampled;
  sampled.sensor.samples = 2;
  for (const PlannedSetup &setup : {phased, sampled}) {
    const FramePlan watched = plan(setup, automatic(1e-5));
    CHECK_FALSE(watched.surely_kept);
    REQUIRE(watched.bound);
    CHECK(watched.bound->limit_m <= 1e-5);
    CHECK_FALSE(watched.claimed_m);
    CHECK_FALSE(watched.claimed_amplitude);
    CHECK_FALSE(plan(setup, {}).claimed_m);
  }
}
