// The errors that random setups claim, beside those that are found over all pixels, for each of the two
// errors that people ask for.

#include "engine/model/error.h"
#include "tests/support/random_setups.h"
#include "tests/support/simulator.h"
#include "tests/whole/uncertain_pixels.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr std::uint32_t claiming_setups = 200;

// The errors of one setup.
struct Claim {
  std::string refusal; // empty where there is a frame
  std::optional<double> claimed_m;
  double found_m = 0.0; // of the returns that keep what was asked for
  std::size_t returns = 0, beyond = 0,
              broken = 0; // with light; that may be off by more; that are beyond their bounds
};

bool sees_the_same(const Measurement &measured, const reference::Frame &expected, const Sensor &sensor,
                   std::size_t pixel) {
  const std::size_t samples = sensor.samples, column = pixel % sensor.resolution.x,
                    row = pixel / sensor.resolution.x;
  for (std::size_t y = row * samples; y < (row + 1) * samples; ++y)
    for (std::size_t x = column * samples; x < (column + 1) * samples; ++x) {
      const std::size_t at = y * sensor.resolution.x * samples + x;
      if (measured.sample_triangle_id[at] != expected.sample_triangle_id[at])
        return false;
    }
  return true;
}

Claim claim_of(Simulator &simulator, const RandomSetup &setup, double max_error_m) {
  Accuracy accuracy;
  accuracy.mode = Mode::automatic;
  accuracy.max_error_m = max_error_m;
  Measurement measured;
  try {
    simulator.prepare(setup.scene, setup.sensor, setup.illuminators, setup.backscatter, setup.shadows,
                      accuracy);
    measured = simulator.measure();
  } catch (const Error &error) {
    CHECK(error.code() == ExitCode::accuracy);
    return {.refusal = error.what(), .claimed_m = {}};
  }
  const auto expected =
      reference::simulate(setup.scene, setup.sensor, setup.illuminators, setup.backscatter,
                          {.shadows = setup.shadows, .keep_visibility = setup.shadows == Shadows::automatic});
  const std::vector<bool> left_out = uncertain_pixels(setup, measured, expected);
  Claim claim{.refusal = "", .claimed_m = measured.accuracy.claimed_m};
  for (std::size_t pixel = 0; pixel < left_out.size(); ++pixel)
    for (std::size_t f = 0; f < expected.returns.size(); ++f) {
      if (left_out[pixel] || expected.returns[f].amplitude[pixel] == 0 ||
          !sees_the_same(measured, expected, setup.sensor, pixel))
        continue;
      const double error_m = std::abs(std::remainder(
          static_cast<double>(measured.returns[f].distance_m[pixel]) - expected.returns[f].distance_m[pixel],
          expected.returns[f].ambiguity_m));
      const double bound_m = static_cast<double>(measured.returns[f].error_bound_m[pixel]);
      ++claim.returns;
      claim.broken += !(error_m <= bound_m);
      if (bound_m > max_error_m)
        ++claim.beyond;
      else
        claim.found_m = std::max(claim.found_m, error_m);
    }
  return claim;
}

double median(std::vector<double> values) {
  if (values.empty())
    return 0.0;
  std::ranges::sort(values);
  return values[values.size() / 2];
}

// At most: what is claimed over what is found, in the median, and the share of the setups that is refused.
void check_claims(double max_error_m, double largest_claim_over_found, double most_refused) {
  SimulatorOptions options;
  options.keep_sample_ids = options.keep_visibility = true;
  options.keep_error_bound = true;
  options.loop = DiodeLoop::looped;
  Simulator simulator = make_simulator(options);
  std::vector<double> ratios;
  std::size_t refused = 0;
  for (std::uint32_t seed = 0; seed < claiming_setups; ++seed) {
    const RandomSetup setup = random_setup(seed);
    INFO("seed " << seed << ", budget " << 1e6 * max_error_m << " um");
    const Claim claim = claim_of(simulator, setup, max_error_m);
    std::string kinds;
    for (const std::string &kind : setup.kinds)
      kinds += kind + "; ";
    fmt::print("{:3} {:10.4f} {:10.4f} {:8.2f} {:5} of {:5} {} {} {}\n", seed,
               1e6 * claim.claimed_m.value_or(NAN), 1e6 * claim.found_m,
               claim.claimed_m.value_or(NAN) / claim.found_m, claim.beyond, claim.returns, claim.broken,
               kinds, claim.refusal);
    refused += !claim.refusal.empty();
    if (!claim.refusal.empty())
      continue;
    CHECK(claim.broken == 0);
    CHECK(claim.found_m <= max_error_m);
    CHECK(claim.claimed_m);
    CHECK(claim.found_m <= claim.claimed_m.value_or(0.0));
    if (claim.found_m > 0.0)
      ratios.push_back(*claim.claimed_m / claim.found_m);
  }
  fmt::print("within {:g} um: {} of {} refused, claimed over found: median {:.3g} of {}\n", 1e6 * max_error_m,
             refused, claiming_setups, median(ratios), ratios.size());
  CHECK(median(ratios) <= largest_claim_over_found);
  CHECK(static_cast<double>(refused) <= most_refused * claiming_setups);
}

} // namespace

TEST_CASE("random setups claim little more than is found", "[long]") { check_claims(100e-6, 20.0, 0.05); }

TEST_CASE("random setups claim little more than is found, within ten micrometres", "[long]") {
  check_claims(10e-6, 5.0, 0.05);
}
