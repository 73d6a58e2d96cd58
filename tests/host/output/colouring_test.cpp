#include "host/output/pictures/colouring.h"
#include "tests/host/output/nan_value.h"

#include <catch2/catch.hpp>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

using Scale = ColourScale;

Colouring colouring_of_values(const std::vector<float> &values, Scale scale) {
  return colouring_of(spread_of_values(values), scale);
}

} // namespace

TEST_CASE("the range leaves outliers out and suits its scale") {
  std::vector<float> values(1001);
  std::iota(values.begin(), values.end(), 0.0f);
  values.back() = 1e9f;
  CHECK(colouring_of_values(values, Scale::sequential).range.min == 5.0);
  CHECK(colouring_of_values(values, Scale::sequential).range.max == 995.0);
  CHECK(colouring_of_values(values, Scale::zero_centred).range.min == -995.0);
  CHECK(colouring_of_values(values, Scale::zero_centred).range.max == 995.0);
  CHECK(colouring_of_values(values, Scale::turn).range.max == Approx(6.283185307));
  CHECK(colouring_of_values(values, Scale::share).range.min == 0.0);
  CHECK(colouring_of_values(values, Scale::share).range.max == 1.0);
}

TEST_CASE("signed values of one sign, closer to each other than to zero, show their differences") {
  const Colouring narrow = colouring_of_values({2.5f, 2.6f, 2.7f}, Scale::zero_centred);
  CHECK(narrow.colours == &viridis);
  CHECK(narrow.range.min == Approx(2.5));
  CHECK(narrow.range.max == Approx(2.7));
  const Colouring below = colouring_of_values({-2.7f, -2.5f}, Scale::zero_centred);
  CHECK(below.colours == &viridis);
  CHECK(below.range.min == Approx(-2.7));
  for (const std::vector<float> &wide :
       {std::vector{1.0f, 2.5f}, {-0.1f, 3.0f}, {0.0f, 1.0f}, {-2.5f, -1.0f}})
    CHECK(colouring_of_values(wide, Scale::zero_centred).colours == &blue_white_red);
}

TEST_CASE("constant and empty images have a range of some extent about their value") {
  for (const float value : {0.0f, 2.0f, -1e-20f, 1e20f, nan_value})
    for (const Scale scale : {Scale::sequential, Scale::zero_centred, Scale::turn}) {
      const Range range = colouring_of_values({value, value}, scale).range;
      CHECK(range.span() > 0.0);
      if (scale == Scale::sequential && !std::isnan(value))
        CHECK(0.5 * (range.min + range.max) == Approx(static_cast<double>(value)));
    }
}

TEST_CASE("what is constant, what is empty, and what is neither") {
  CHECK(spread_of_values(std::vector{2.0f, 2.0f, nan_value}).is_constant());
  CHECK(spread_of_values(std::vector{0.0f}).is_constant());
  CHECK(spread_of_values(std::vector{2.0f, 2.000001f}).is_constant());
  CHECK_FALSE(spread_of_values(std::vector{2.0f, 2.001f}).is_constant());
  CHECK_FALSE(spread_of_values(std::vector{nan_value}).is_constant());
  CHECK(spread_of_values(std::vector{nan_value, std::numeric_limits<float>::infinity()}).is_empty());
  CHECK(spread_of_values(std::vector<float>()).is_empty());
}

TEST_CASE("several images have the hull of their ranges, empty ones none") {
  const ValueSpread low = spread_of_values(std::vector{1.0f, 2.0f}), none;
  const ValueSpread high = spread_of_values(std::vector{5.0f, 7.0f});
  CHECK(hull(low, high).robust.min == 1.0);
  CHECK(hull(low, high).robust.max == 7.0);
  CHECK(hull(high, low).least == 1.0);
  CHECK(hull(none, low).robust.max == 2.0);
  CHECK(hull(low, none).robust.max == 2.0);
  CHECK(hull(none, none).is_empty());
}

TEST_CASE("the first dozens of ids differ in colour") {
  std::set<Colour> colours;
  for (std::uint32_t id = 0; id < 24; ++id)
    colours.insert(colour_of_id(id));
  CHECK(colours.size() == 24);
  CHECK(colours.count(no_value_colour) == 0);
  CHECK(colour_of_id(0xfffffffeu) != no_value_colour);
}
