// The normal numbers of read noise, as the camera's electrons show them: those of two taps share a word.

#include "tests/electronics/fixture.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr std::uint32_t images_of_pixel = 4;

// Far below the well and far above 0, with a noise next to which shot noise is nothing.
LightLevels of_read_noise_alone() {
  Electronics electronics = plain_electronics();
  electronics.read_noise_e = 1e5;
  electronics.full_well_e = 1e8;
  electronics.dark_current_e_per_s = 0.0;
  return light_levels(electronics, images_of_pixel, std::vector(100, 2e3), 1.1, 2000);
}

struct Numbers {
  std::vector<double> of_a, of_b;
};

Numbers normal_numbers() {
  const LightLevels levels = of_read_noise_alone();
  const Return frame = noisy_frame(levels, 3).returns[0];
  Numbers numbers;
  const double deviation_e = std::sqrt(1e10 + 1e3);
  for (std::uint32_t k = 0; k < images_of_pixel; ++k) {
    const double part_e = 0.6 * 1e3 * std::cos(1.1 - 2.0 * std::acos(-1.0) * k / images_of_pixel);
    for (std::size_t i = 0; i < frame.tap_a_e[k].size(); ++i) {
      numbers.of_a.push_back((frame.tap_a_e[k][i] - (1e3 + part_e)) / deviation_e);
      numbers.of_b.push_back((frame.tap_b_e[k][i] - (1e3 - part_e)) / deviation_e);
    }
  }
  return numbers;
}

// Mean of f over the numbers, over its standard error away from `expected`.
double errors_from(const std::vector<double> &numbers, double expected, auto f) {
  Moments moments;
  for (const double number : numbers)
    moments.add(f(number));
  return (moments.mean() - expected) / std::sqrt(moments.variance() / moments.count());
}

} // namespace

TEST_CASE("normal numbers have the moments, the tails and the distribution of normal numbers") {
  Numbers numbers = normal_numbers();
  for (std::vector<double> *const of : {&numbers.of_a, &numbers.of_b}) {
    const double expected[] = {0.0, 1.0, 0.0, 3.0, 0.0, 15.0, 0.0, 105.0};
    for (int power = 1; power <= 8; ++power) {
      const double errors =
          errors_from(*of, expected[power - 1], [&](double z) { return std::pow(z, power); });
      fmt::print("normal numbers to the power of {}: {:.2f} standard errors\n", power, errors);
      CHECK(std::abs(errors) < 4.0);
    }
    for (const double limit : {1.0, 2.0, 3.0, 4.0})
      CHECK(std::abs(errors_from(*of, std::erfc(limit / std::sqrt(2.0)),
                                 [&](double z) { return std::abs(z) > limit ? 1.0 : 0.0; })) < 4.0);
    std::ranges::sort(*of);
    CHECK(of->front() > -5.41);
    CHECK(of->back() < 5.41);
    double farthest = 0.0;
    const auto count = static_cast<double>(of->size());
    for (std::size_t i = 0; i < of->size(); ++i)
      farthest = std::max(farthest, std::abs(0.5 * std::erfc(-(*of)[i] / std::sqrt(2.0)) -
                                             (static_cast<double>(i) + 0.5) / count));
    fmt::print("{} normal numbers, distribution off by {:.2e}, {:.2f} / sqrt(n)\n", of->size(), farthest,
               farthest * std::sqrt(count));
    CHECK(farthest * std::sqrt(count) < 1.63); // Kolmogorov and Smirnov's, 1 %
  }
}

TEST_CASE("the two normal numbers of a word know nothing of each other") {
  const Numbers numbers = normal_numbers();
  for (const auto &[power_a, power_b] :
       {std::pair(1, 1), std::pair(2, 2), std::pair(1, 2), std::pair(3, 3)}) {
    Moments products;
    for (std::size_t i = 0; i < numbers.of_a.size(); ++i) {
      const auto centred = [](double z, int power) { return std::pow(z, power) - (power == 2 ? 1.0 : 0.0); };
      products.add(centred(numbers.of_a[i], power_a) * centred(numbers.of_b[i], power_b));
    }
    CHECK(std::abs(products.mean()) < 4.0 * std::sqrt(products.variance() / products.count()));
  }
}
