// The promise of mode auto: whatever the setup, the distance error is within what was asked for in every
// pixel, or the simulator said that it cannot be.

#include "engine/model/error.h"
#include "tests/comparison/comparison.h"
#include "tests/support/random_setups.h"
#include "tests/support/simulator.h"
#include "tests/whole/uncertain_pixels.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <map>
#include <optional>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr std::uint32_t setups = 200;
// At most these shares of the setups may be refused: those with measured diagrams, of whose error theory has
// no bound, and those whose rounding may exceed the budget. The latter have returns of two lights that
// cancel, or a long distance whose last bit in float is more than a micrometre, and most have budgets below
// 10 micrometres.
constexpr double most_without_bound = 0.0, most_beyond_rounding = 0.25;

Accuracy within_budget(const RandomSetup &setup) {
  Accuracy accuracy;
  accuracy.mode = Mode::automatic;
  accuracy.max_error_m = setup.max_error_m;
  accuracy.strict = true;
  return accuracy;
}

Measurement measure(Simulator &simulator, const RandomSetup &setup) {
  simulator.prepare(setup.scene, setup.sensor, setup.illuminators, setup.backscatter, setup.shadows,
                    within_budget(setup));
  return simulator.measure();
}

// The result of one setup.
struct Outcome {
  std::string refusal; // empty where there is a frame
  std::size_t pixels = 0, left_out = 0;
  double error_over_budget = 0.0;
  AccuracyReport accuracy;
};

Outcome outcome_of(Simulator &simulator, const RandomSetup &setup) {
  Measurement measured;
  try {
    measured = measure(simulator, setup);
  } catch (const Error &error) {
    CHECK(error.code() == ExitCode::accuracy);
    return {.refusal = error.what(), .accuracy = {}};
  }
  const auto expected =
      reference::simulate(setup.scene, setup.sensor, setup.illuminators, setup.backscatter,
                          {.shadows = setup.shadows, .keep_visibility = setup.shadows == Shadows::automatic});
  const std::vector<bool> left_out = uncertain_pixels(setup, measured, expected);
  const Comparison comparison = compare(measured, expected, setup.scene, setup.sensor, left_out);
  CHECK(comparison.disagreements == 0);
  return {.refusal = "",
          .pixels = comparison.pixels,
          .left_out = static_cast<std::size_t>(std::ranges::count(left_out, true)),
          .error_over_budget = comparison.distance_max_m / setup.max_error_m,
          .accuracy = measured.accuracy};
}

// The results of all setups of a kind.
struct Row {
  std::size_t setups = 0, refused = 0, pixels = 0, left_out = 0;
  double error_over_budget = 0.0;

  void add(const Outcome &outcome) {
    ++setups;
    refused += !outcome.refusal.empty();
    pixels += outcome.pixels;
    left_out += outcome.left_out;
    error_over_budget = std::max(error_over_budget, outcome.error_over_budget);
  }
};

void print(const std::map<std::string, Row> &rows) {
  fmt::print("{:<24}{:>8}{:>9}{:>10}{:>10}{:>14}\n", "setups of a kind", "setups", "refused", "pixels",
             "left out", "error/budget");
  for (const auto &[kind, row] : rows)
    fmt::print("{:<24}{:>8}{:>9}{:>10}{:>10}{:>14.3g}\n", kind, row.setups, row.refused, row.pixels,
               row.left_out, row.error_over_budget);
}

std::string budget_kind(double max_error_m) {
  const int decade = static_cast<int>(std::floor(std::log10(max_error_m * 1e6)));
  return fmt::format("budget of 1e{} um", std::clamp(decade, 0, 3));
}

bool same_bits(const std::vector<float> &a, const std::vector<float> &b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

SimulatorOptions keeping_everything() {
  SimulatorOptions options;
  options.keep_sample_ids = options.keep_visibility = true;
  options.loop = DiodeLoop::looped; // compiles in a fraction of the time of a straight line
  return options;
}

// Every `step`-th setup.
void check_budgets(std::uint32_t step) {
  Simulator simulator = make_simulator(keeping_everything());
  std::map<std::string, Row> rows;
  std::size_t without_bound = 0;
  for (std::uint32_t seed = 0; seed < setups; seed += step) {
    const RandomSetup setup = random_setup(seed);
    INFO("seed " << seed << ", budget " << 1e6 * setup.max_error_m << " um");
    const Outcome outcome = outcome_of(simulator, setup);
    CHECK(outcome.error_over_budget <= 1.0);
    CHECK(outcome.accuracy.claimed_m.value_or(0.0) <= setup.max_error_m);
    CHECK(outcome.accuracy.found_m.value_or(0.0) <= setup.max_error_m);
    if (!outcome.refusal.empty())
      fmt::print("seed {}, {:.3g} um: {}\n", seed, 1e6 * setup.max_error_m, outcome.refusal);
    without_bound += outcome.refusal.find("no bound") != std::string::npos;
    rows["all"].add(outcome);
    rows[budget_kind(setup.max_error_m)].add(outcome);
    for (const std::string &kind : setup.kinds)
      rows[kind].add(outcome);
  }
  print(rows);
  fmt::print("refused: {} without a bound, {} beyond it\n", without_bound,
             rows["all"].refused - without_bound);
  const std::size_t count = rows["all"].setups;
  CHECK(static_cast<double>(without_bound) <= most_without_bound * static_cast<double>(count));
  if (step == 1) // the share is of all setups; a part of them may have more or fewer
    CHECK(static_cast<double>(rows["all"].refused - without_bound) <=
          most_beyond_rounding * static_cast<double>(count));
  CHECK(rows["all"].pixels >= count * 100);
  CHECK(rows["all"].left_out <= rows["all"].pixels / 50);
}

void check_bits_twice(std::uint32_t step) {
  Simulator first = make_simulator(), second = make_simulator();
  for (std::uint32_t seed = 0; seed < setups; seed += step) {
    const RandomSetup setup = random_setup(seed);
    INFO("seed " << seed);
    try {
      const Measurement one = measure(first, setup), other = measure(second, setup);
      for (std::size_t f = 0; f < one.returns.size(); ++f) {
        CHECK(same_bits(one.returns[f].distance_m, other.returns[f].distance_m));
        CHECK(same_bits(one.returns[f].amplitude, other.returns[f].amplitude));
      }
    } catch (const Error &error) {
      CHECK(error.code() == ExitCode::accuracy);
    }
  }
}

} // namespace

TEST_CASE("a few random setups stay within their budgets", "[smoke]") { check_budgets(50); }

TEST_CASE("some random setups stay within their budgets") { check_budgets(60); }

TEST_CASE("random setups stay within their budgets", "[long]") { check_budgets(1); }

TEST_CASE("some random setups give the same bits twice") { check_bits_twice(100); }

TEST_CASE("random setups give the same bits twice", "[long]") { check_bits_twice(25); }
