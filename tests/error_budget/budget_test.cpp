#include "engine/error_budget/plan.h"

#include <bit>
#include <catch2/catch.hpp>
#include <limits>

using namespace pmdsim;

namespace {

Accuracy within(double max_error_m, double max_amplitude_error = std::numeric_limits<double>::infinity()) {
  Accuracy accuracy;
  accuracy.mode = Mode::automatic;
  accuracy.max_error_m = max_error_m;
  accuracy.max_amplitude_error = max_amplitude_error;
  return accuracy;
}

AccuracyReport found(double error_m, double amplitude) {
  AccuracyReport report;
  report.found_m = error_m;
  report.found_amplitude = amplitude;
  return report;
}

shader::BudgetViolations broken(std::uint32_t returns, float worst_m, float amplitude) {
  return {returns,
          std::bit_cast<decltype(shader::BudgetViolations::worst_m)>(worst_m),
          std::bit_cast<decltype(shader::BudgetViolations::amplitude)>(amplitude),
          0,
          0,
          0};
}

constexpr double ambiguity_m = 7.5;

} // namespace

TEST_CASE("a frame within its errors keeps the promise") {
  CHECK(!beyond_check({}, within(1e-5), ambiguity_m)); // not checked
  CHECK(!beyond_check(found(1e-5, 0.5), within(1e-5), ambiguity_m));
  // Half a unit in the last place of the distances themselves is not the sum's.
  CHECK(!beyond_check(found(1e-5 + 0x1p-24 * ambiguity_m, 0.0), within(1e-5), ambiguity_m));
  CHECK(beyond_check(found(1e-5 + 0x1p-23 * ambiguity_m, 0.0), within(1e-5), ambiguity_m));
}

TEST_CASE("a breach says by how much and what was asked for") {
  CHECK(beyond_check(found(2e-5, 1e-3), within(1e-5), ambiguity_m) ==
        "pixels evaluated exactly are off by up to 0.02 mm; expected at most 0.01 mm");
  CHECK(beyond_check(found(5e-6, 1e-3), within(1e-5, 1e-4), ambiguity_m) ==
        "pixels evaluated exactly are off by up to 0.005 mm and 0.001 of the amplitude; expected at most "
        "0.01 mm "
        "and 0.0001 of the amplitude");
  const auto breach = beyond_bound(broken(3, 0.5f, 2.0f), within(1e-3));
  REQUIRE(breach);
  CHECK(breach->starts_with("3 returns of pixels"));
  CHECK(breach->ends_with("off by up to 500 mm; expected at most 1 mm"));
}
