// The yardstick of the benchmark: its sums against double, and what it chooses to sum.

#include "host/bench/native/native_bench.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace pmdsim;

namespace {

// Points 1 to 5 m before a light of some decimetres, on whichever side.
NativeWork random_work(std::size_t points, std::size_t diodes, unsigned seed) {
  std::mt19937 random(seed);
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const glm::dvec3 middle_m(within(-1, 1), within(-1, 1), within(-1, 1));
  NativeWork work;
  work.modulation_hz = within(5e6, 30e6);
  for (std::size_t i = 0; i < points; ++i)
    work.points_m.push_back(middle_m + glm::dvec3(within(-0.7, 0.7), within(-0.7, 0.7), within(1, 5)));
  for (std::size_t i = 0; i < diodes; ++i)
    work.diodes.push_back(
        {middle_m + glm::dvec3(within(-0.15, 0.15), within(-0.15, 0.15), within(-0.05, 0.05)),
         within(0.1, 10.0)});
  return work;
}

Setup wall_setup() {
  Setup setup;
  setup.backscatter = Backscatter::constant;
  setup.start.sensors.resize(1);
  setup.start.sensors.front().resolution = {2, 2};
  setup.start.illuminators.push_back(monostatic_illuminator(node_from_camera()));
  return setup;
}

Measurement four_pixels() {
  Measurement measurement;
  measurement.range_m = {2.0f, 2.0f, 2.0f, NAN};
  measurement.coverage = {1.0f, 1.0f, 1.0f, 0.0f};
  measurement.lit = {1.0f, 1.0f, 1.0f, 0.0f};
  return measurement;
}

} // namespace

TEST_CASE("native sums of every instruction set here are those in double") {
  const auto sets = available_native_sums();
  REQUIRE(std::string(sets.back()->instructions) == "baseline");
  for (const NativeSums *sums : sets)
    // Fewer points than a tile holds, some that leave its last one half empty, more threads than tiles.
    for (const std::size_t points : {1u, 100u, 3333u})
      for (const unsigned threads : {1u, 3u}) {
        INFO(sums->instructions << ", " << points << " points, " << threads << " threads");
        NativeKernel kernel(random_work(points, 37, 1), *sums, threads);
        CHECK(kernel.interactions() == static_cast<double>(37 * points));
        kernel.run_s(sums->by_moments);
        CHECK(kernel.error_max_m() < 3e-6);
        kernel.run_s(sums->by_series[3].sum);
        CHECK(kernel.error_max_m() < 3e-6);
      }
}

TEST_CASE("the native sum's third moment counts") {
  // Lopsided, seen from the side, at a high frequency: without it the distance would be off by 50
  // micrometres.
  NativeWork work{{{1.0, 0.0, 1.0}}, {{{0.2, 0.0, 0.0}, 1.0}, {{-0.05, 0.0, 0.0}, 4.0}}, 48e6};
  for (const NativeSums *sums : available_native_sums()) {
    NativeKernel kernel(work, *sums, 1);
    kernel.run_s(sums->by_moments);
    CHECK(kernel.error_max_m() < 3e-6);
  }
}

TEST_CASE("each power that the native series takes brings it closer") {
  NativeKernel kernel(random_work(500, 20, 2), *available_native_sums().front(), 2);
  double before_m = 1.0;
  for (const auto &[powers, sum] : kernel.sums().by_series) {
    INFO(powers);
    kernel.run_s(sum);
    CHECK(kernel.error_max_m() < before_m / 3);
    before_m = kernel.error_max_m();
  }
}

TEST_CASE("a native sum that is wrong in one point is found out") {
  NativeKernel kernel(random_work(500, 20, 3), *available_native_sums().front(), 1);
  CHECK(kernel.error_max_m() > 1e-3); // nothing is summed yet
}

TEST_CASE("the native ring and wall are the paper's") {
  const NativeWork work = ring_and_wall();
  CHECK(work.points_m.size() == 640 * 640);
  CHECK(work.points_m.front().x == Approx(-0.2 + 0.2 / 640));
  CHECK(work.points_m.back().y == Approx(0.2 - 0.2 / 640));
  REQUIRE(work.diodes.size() == 240);
  const auto bench = checked_bench({work, "test"}, *available_native_sums().front(), 2);
  CHECK(bench.points == "test");
  REQUIRE(bench.series);
  CHECK(bench.series->powers == 4);
  CHECK(bench.moments_error_m < 0.5e-6);
  CHECK(bench.series_error_m < 1e-6);
}

TEST_CASE("the native kernel takes the setup's points and diodes where it models the setup") {
  const Setup setup = wall_setup();
  const ChosenWork own = native_work(setup, setup.start.sensors.front(), four_pixels());
  CHECK(own.points == "the setup's diodes and points");
  REQUIRE(own.work.points_m.size() == 3); // one sees nothing
  for (const glm::dvec3 &point_m : own.work.points_m)
    CHECK(glm::length(point_m) == Approx(2.0));
  CHECK(own.work.points_m[0].x < 0.0);
  CHECK(own.work.points_m[0].y < 0.0);
  CHECK(own.work.points_m[1].x > 0.0);
  CHECK(own.work.points_m[2].y > 0.0);
  REQUIRE(own.work.diodes.size() == 1);
  CHECK(glm::length(own.work.diodes.front().position_m) < 1e-12);
}

TEST_CASE("else it says why not") {
  const auto reason_of = [](const auto &change) {
    Setup setup = wall_setup();
    Measurement measurement = four_pixels();
    change(setup, measurement);
    const ChosenWork chosen = native_work(setup, setup.start.sensors.front(), measurement);
    CHECK(chosen.work.diodes.size() == 240);
    return chosen.points;
  };
  const std::string other = "a ring's diodes and a wall's points, as ";
  CHECK(reason_of([](Setup &setup, Measurement &) { setup.backscatter = Backscatter::lambert; }) ==
        other + "the backscatter is not constant");
  CHECK(reason_of([](Setup &setup, Measurement &) {
          setup.start.sensors.front().waveform.kind = Waveform::Kind::square;
        }) == other + "the waveform is no sine");
  CHECK(reason_of([](Setup &setup, Measurement &) {
          setup.start.illuminators.front().diodes.front().pattern.kind = Pattern::Kind::cosine;
        }) == other + "the diodes are not isotropic");
  CHECK(reason_of([](Setup &setup, Measurement &) {
          setup.start.illuminators.push_back(setup.start.illuminators.front());
          setup.start.illuminators.back().modulation_phase_rad = 1.0;
        }) == other + "the illuminators are not in phase");
  CHECK(reason_of([](Setup &, Measurement &measurement) { measurement.lit[1] = 0.5f; }) ==
        other + "some diodes do not reach some points");
  CHECK(reason_of([](Setup &, Measurement &measurement) {
          measurement.range_m.assign(4, NAN);
          measurement.coverage.assign(4, 0.0f);
        }) == other + "nothing is seen");
  CHECK(reason_of([](Setup &setup, Measurement &) {
          setup.start.illuminators.front().diodes.front().intensity_w_sr = 0.0;
        }) == other + "the diodes are dark");
}

TEST_CASE("where four moments do not do, the native kernel takes the ring and the wall") {
  NativeWork wide = random_work(100, 20, 4);
  for (auto &diode : wide.diodes)
    diode.position_m *= 10.0;
  const auto bench = checked_bench({wide, "test"}, *available_native_sums().front(), 1);
  CHECK(bench.points == "a ring's diodes and a wall's points, as the setup takes more moments");
  CHECK(bench.kernel.points() == 640 * 640);
}
