#include "host/output/pictures/axis.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;

namespace {

std::vector<std::string> labels(const Range &range, int max_ticks) {
  std::vector<std::string> texts;
  for (const Tick &tick : make_axis(range, max_ticks).ticks)
    texts.push_back(tick.label);
  return texts;
}

using Labels = std::vector<std::string>;

} // namespace

TEST_CASE("ticks stand at round numbers without needless digits") {
  CHECK(labels({0.0, 10.0}, 6) == Labels{"0", "2", "4", "6", "8", "10"});
  CHECK(labels({-1.0, 1.0}, 5) == Labels{"−1.0", "−0.5", "0.0", "0.5", "1.0"});
  CHECK(labels({2.003, 2.022}, 5) == Labels{"2.005", "2.010", "2.015", "2.020"});
  CHECK(labels({-0.5, 639.5}, 8) == Labels{"0", "100", "200", "300", "400", "500", "600"});
}

TEST_CASE("ticks at the very ends survive rounding") {
  CHECK(labels({0.1, 0.3}, 3) == Labels{"0.1", "0.2", "0.3"});
}

TEST_CASE("there are never too many ticks and always some, whatever the range") {
  for (const double span : {1e-30, 1e-6, 0.37, 1.0, 7.0, 99.0, 1e9, 1e30})
    for (const int max_ticks : {2, 5, 8, 11}) {
      const Axis axis = make_axis({-0.3 * span, 0.7 * span}, max_ticks);
      CHECK(axis.ticks.size() >= 1);
      CHECK(axis.ticks.size() <= static_cast<std::size_t>(max_ticks));
      for (const Tick &tick : axis.ticks) {
        CHECK(tick.value >= -0.3 * span * (1.0 + 1e-9));
        CHECK(tick.value <= 0.7 * span * (1.0 + 1e-9));
      }
    }
}

TEST_CASE("a logarithmic axis has powers of ten, and what is between where these are few") {
  const auto log_labels = [](const Range &range) {
    Labels texts;
    for (const Tick &tick : make_log_axis(range).ticks)
      texts.push_back(tick.label);
    return texts;
  };
  CHECK(log_labels({0.01, 100.0}) == Labels{"0.01", "0.1", "1", "10", "100"});
  CHECK(log_labels({0.3, 12.0}) == Labels{"0.5", "1", "2", "5", "10"});
  CHECK(log_labels({1.1, 4.5}) == Labels{"2"});
  const Axis axis = make_log_axis({0.1, 1000.0});
  CHECK(axis.range.min == Approx(-1.0));
  CHECK(axis.range.span() == Approx(4.0));
  CHECK(axis.ticks[1].value == 0.0);
}

TEST_CASE("small and large numbers leave their power of ten to the title") {
  const Axis small = make_axis({0.0, 5e-6}, 6);
  CHECK(small.exponent == -6);
  CHECK(small.ticks.back().label == "5");
  CHECK(axis_title("amplitude", "W/(m² sr)", small.exponent) == "amplitude (10⁻⁶ W/(m² sr))");
  const Axis large = make_axis({0.0, 2e12}, 5);
  CHECK(large.exponent == 12);
  CHECK(axis_title("amplitude", "", large.exponent) == "amplitude (10¹²)");
  CHECK(make_axis({0.0, 640.0}, 5).exponent == 0);
  CHECK(axis_title("deformation", "mm", 0) == "deformation (mm)");
  CHECK(axis_title("coverage", "", 0) == "coverage");
}
