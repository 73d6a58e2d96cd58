#include "host/output/tables/deformation.h"
#include "tests/host/output/nan_value.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

float single_deformation_mm(float bistatic_m, float monostatic_m, double ambiguity_m) {
  return deformation_mm(std::vector{bistatic_m}, std::vector{monostatic_m}, ambiguity_m).front();
}

} // namespace

TEST_CASE("deformation is bistatic minus monostatic in millimetres") {
  CHECK(single_deformation_mm(2.5f, 2.0f, 8.0) == 500.0f);
  CHECK(single_deformation_mm(2.0f, 2.5f, 8.0) == -500.0f);
}

TEST_CASE("deformation wraps to half the ambiguity, the upper end included") {
  CHECK(single_deformation_mm(0.25f, 7.75f, 8.0) == 500.0f);
  CHECK(single_deformation_mm(7.75f, 0.25f, 8.0) == -500.0f);
  CHECK(single_deformation_mm(4.0f, 0.0f, 8.0) == 4000.0f);
  CHECK(single_deformation_mm(0.0f, 4.0f, 8.0) == 4000.0f);
}

TEST_CASE("a pixel without a distance has no deformation") {
  CHECK(std::isnan(single_deformation_mm(nan_value, 1.0f, 8.0)));
  CHECK(std::isnan(single_deformation_mm(1.0f, nan_value, 8.0)));
}

TEST_CASE("statistics leave pixels without a value out") {
  const std::vector<float> values{1.0f, nan_value, -3.0f, 5.0f, nan_value, 1.0f};
  const DeformationStatistics statistics = statistics_of(values, {3, 2});
  CHECK(statistics.mean_mm == Approx(1.0));
  CHECK(statistics.min_mm == -3.0);
  CHECK(statistics.max_mm == 5.0);
  CHECK(statistics.rms_mm == Approx(3.0));
}

TEST_CASE("the centre is the mean of the middle 1, 2 or 4 pixels") {
  CHECK(statistics_of(std::vector{0.f, 1.f, 2.f, 3.f, 4.f, 5.f, 6.f, 7.f, 90.f}, {3, 3}).centre_mm == 4.0);
  CHECK(statistics_of(std::vector{0.f, 1.f, 2.f, 30.f}, {4, 1}).centre_mm == 1.5);
  CHECK(statistics_of(std::vector{0.f, 1.f, 2.f, 30.f}, {1, 4}).centre_mm == 1.5);
  CHECK(statistics_of(std::vector{1.f, 2.f, 3.f, 6.f}, {2, 2}).centre_mm == 3.0);
  CHECK(statistics_of(std::vector{1.f, nan_value, 3.f, 5.f}, {2, 2}).centre_mm == 3.0);
}

TEST_CASE("statistics of nothing are NaN") {
  const DeformationStatistics statistics = statistics_of(std::vector{nan_value, nan_value}, {2, 1});
  CHECK(std::isnan(statistics.mean_mm));
  CHECK(std::isnan(statistics.min_mm));
  CHECK(std::isnan(statistics.max_mm));
  CHECK(std::isnan(statistics.rms_mm));
  CHECK(std::isnan(statistics.centre_mm));
}
