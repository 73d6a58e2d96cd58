#include "host/output/tables/deformation.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace pmdsim;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double single_deformation_mm(double bistatic_m, double monostatic_m, double ambiguity_m) {
  return deformation_mm(std::vector{bistatic_m}, std::vector{monostatic_m}, ambiguity_m).front();
}

} // namespace

TEST_CASE("deformation is bistatic minus monostatic in millimetres") {
  CHECK(single_deformation_mm(2.5, 2.0, 8.0) == 500.0);
  CHECK(single_deformation_mm(2.0, 2.5, 8.0) == -500.0);
}

TEST_CASE("a deformation below a float's step at its distance is there") {
  CHECK(single_deformation_mm(2.0 + 1e-9, 2.0, 8.0) == Approx(1e-6).epsilon(1e-6));
}

TEST_CASE("deformation wraps to half the ambiguity, the upper end included") {
  CHECK(single_deformation_mm(0.25, 7.75, 8.0) == 500.0);
  CHECK(single_deformation_mm(7.75, 0.25, 8.0) == -500.0);
  CHECK(single_deformation_mm(4.0, 0.0, 8.0) == 4000.0);
  CHECK(single_deformation_mm(0.0, 4.0, 8.0) == 4000.0);
}

TEST_CASE("a pixel without a distance has no deformation") {
  CHECK(std::isnan(single_deformation_mm(not_a_number, 1.0, 8.0)));
  CHECK(std::isnan(single_deformation_mm(1.0, not_a_number, 8.0)));
}

TEST_CASE("statistics leave pixels without a value out") {
  const std::vector<double> values{1.0, not_a_number, -3.0, 5.0, not_a_number, 1.0};
  const DeformationStatistics statistics = statistics_of(values, {3, 2});
  CHECK(statistics.mean_mm == Approx(1.0));
  CHECK(statistics.min_mm == -3.0);
  CHECK(statistics.max_mm == 5.0);
  CHECK(statistics.rms_mm == Approx(3.0));
  CHECK(statistics.varying_mm == Approx(std::sqrt(8.0)));
}

TEST_CASE("the centre is the mean of the middle 1, 2 or 4 pixels") {
  CHECK(statistics_of(std::vector{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 90.0}, {3, 3}).centre_mm == 4.0);
  CHECK(statistics_of(std::vector{0.0, 1.0, 2.0, 30.0}, {4, 1}).centre_mm == 1.5);
  CHECK(statistics_of(std::vector{0.0, 1.0, 2.0, 30.0}, {1, 4}).centre_mm == 1.5);
  CHECK(statistics_of(std::vector{1.0, 2.0, 3.0, 6.0}, {2, 2}).centre_mm == 3.0);
  CHECK(statistics_of(std::vector{1.0, not_a_number, 3.0, 5.0}, {2, 2}).centre_mm == 3.0);
}

TEST_CASE("statistics of nothing are NaN") {
  const DeformationStatistics statistics = statistics_of(std::vector{not_a_number, not_a_number}, {2, 1});
  CHECK(std::isnan(statistics.mean_mm));
  CHECK(std::isnan(statistics.min_mm));
  CHECK(std::isnan(statistics.max_mm));
  CHECK(std::isnan(statistics.rms_mm));
  CHECK(std::isnan(statistics.centre_mm));
  CHECK(std::isnan(statistics.varying_mm));
}
