// Speed against accuracy: the fronts, the tables and the picture.

#include "host/output/pictures/plots.h"
#include "host/output/tables/tradeoff.h"
#include "tests/host/output/pixel_of.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

TradeoffPoint measured(Sweep sweep, Mode mode, double time_ms, double error_m) {
  TradeoffPoint point;
  point.sweep = sweep;
  point.accuracy.mode = mode;
  point.time = {time_ms, 0.9 * time_ms, 1.2 * time_ms};
  point.smooth = {4000, error_m, 0.5 * error_m};
  point.edges = {96, 10.0 * error_m, 5.0 * error_m};
  return point;
}

TradeoffPoint refused(Mode mode, const std::string &reason) {
  TradeoffPoint point;
  point.accuracy.mode = mode;
  point.refusal = reason;
  return point;
}

std::vector<bool> fronts(std::vector<TradeoffPoint> points) {
  mark_pareto(points);
  std::vector<bool> marked;
  for (const TradeoffPoint &point : points)
    marked.push_back(point.pareto);
  return marked;
}

// A front of five points and one behind it, one refused, and three counts of samples.
Tradeoff example() {
  Tradeoff tradeoff{"ring.json", "pmd", "device", "driver", {}};
  auto &points = tradeoff.points;
  points.push_back(measured(Sweep::modes, Mode::exact, 50.0, 1.2e-7));
  points.push_back(measured(Sweep::modes, Mode::exact, 400.0, 5e-8));
  points.back().accuracy.precision = points.back().report.precision = Precision::fp64;
  points.push_back(refused(Mode::reduced, "no \"weights\", none"));
  points.push_back(measured(Sweep::modes, Mode::reduced, 20.0, 8e-6));
  points.push_back(measured(Sweep::modes, Mode::automatic, 12.0, 4e-5));
  points.push_back(measured(Sweep::modes, Mode::automatic, 60.0, 9e-6));
  for (const std::uint32_t samples : {1u, 2u, 4u}) {
    points.push_back(measured(Sweep::samples, Mode::exact, 50.0 * samples, 1e-4 / samples));
    points.back().samples = samples;
    points.back().reference_samples = 16;
  }
  points.back().adaptive_samples = true;
  mark_pareto(points);
  return tradeoff;
}

std::ptrdiff_t lines(const std::string &text) { return std::ranges::count(text, '\n'); }

// The number of the picture's pixels that are neither white nor grey.
int coloured_pixels(Canvas canvas) {
  return pmdsim::test::count_pixels(canvas, [](std::uint32_t colour) {
    const auto [least, most] = std::minmax({colour & 0xffu, (colour >> 8) & 0xffu, colour >> 16});
    return most > least + 60;
  });
}

} // namespace

TEST_CASE("the front holds what no point beats in both time and error") {
  const auto at = [](double time_ms, double error_m) {
    return measured(Sweep::modes, Mode::exact, time_ms, error_m);
  };
  CHECK(fronts({at(1, 9), at(2, 5), at(3, 5), at(3, 7), at(4, 1), at(1, 10)}) ==
        std::vector{true, true, false, false, true, false});
  CHECK(fronts({at(2, 2), at(2, 2)}) == std::vector{true, true}); // neither is better
  CHECK(fronts({}).empty());
}

TEST_CASE("each sweep has a front of its own, without what was refused or could not be compared") {
  TradeoffPoint without_pixels = measured(Sweep::modes, Mode::exact, 0.1, 0.0);
  without_pixels.smooth = {};
  CHECK(fronts({measured(Sweep::modes, Mode::exact, 1, 1), measured(Sweep::samples, Mode::exact, 2, 2),
                refused(Mode::reduced, "why"), without_pixels}) == std::vector{true, true, false, false});
}

TEST_CASE("JSON holds what scripts rely on, and null where there is nothing") {
  const auto points = tradeoff_json(example())["points"];
  REQUIRE(points.size() == 9);
  CHECK(points[1]["mode"] == "exact");
  CHECK(points[1]["precision"] == "fp64");
  CHECK(points[1]["max_error_m"].is_null());
  CHECK(points[1]["frame_ms"] == 400.0);
  CHECK(points[1]["error_max_m"] == 5e-8);
  CHECK(points[1]["edge_error_rms_m"] == 2.5e-7);
  CHECK(points[1]["pareto"] == true);
  CHECK(points[1]["refused"].is_null());
  CHECK(points[2]["refused"] == "no \"weights\", none");
  CHECK(points[2]["frame_ms"].is_null());
  CHECK(points[2]["max_error_m"] == default_max_error_m);
  CHECK(points[5]["pareto"] == false);
  CHECK(points[7]["samples"] == 2);
  CHECK(points[8]["samples"] == "auto");
  CHECK(points[8]["reference_samples"] == 16);
}

TEST_CASE("the table for other programs has a header and a line a point") {
  const std::string csv = tradeoff_csv(example());
  CHECK(lines(csv) == 10);
  CHECK(csv.starts_with("sweep,mode,max_error_m,precision,"));
  CHECK(csv.find(",false,\"no \"\"weights\"\", none\"\n") != std::string::npos);
  CHECK(tradeoff_csv({}).empty());
}

TEST_CASE("tables for people have a table a sweep, and say why points are missing") {
  const std::string text = tradeoff_text(example()), markdown = tradeoff_markdown(example());
  for (const std::string &table : {text, markdown}) {
    CHECK(table.find("modes and precisions: ") != std::string::npos);
    CHECK(table.find("S = 16, 4000 random pixels beside edges and 96 on them") != std::string::npos);
    CHECK(table.find("refused: reduced, 10 µm: no \"weights\", none\n") != std::string::npos);
  }
  CHECK(markdown.starts_with("`pmdsim tradeoff ring.json`"));
  CHECK(markdown.find("\n|---|---|") != std::string::npos);
  CHECK(markdown.find(
            "\n| exact | - | fp64 | 0 | 1 | 400 | 360 to 480 | 0.05 | 0.025 | 0.5 | 0.25 | - | front |\n") !=
        std::string::npos);
}

TEST_CASE("labels tell the points of a series apart") {
  const auto points = example().points;
  CHECK(point_label(points[0]) == "fp32");
  CHECK(point_label(points[1]) == "fp64");
  CHECK(point_label(points[3]) == "10 µm");
  CHECK(point_label(points[7]) == "S = 2");
  CHECK(point_label(points[8]) == "S = auto");
  CHECK(series_name(points[7]) == "samples");
}

TEST_CASE("the picture shows points and fronts, and can be drawn of none") {
  Tradeoff tradeoff = example();
  const int with_front = coloured_pixels(draw_tradeoff(tradeoff));
  for (TradeoffPoint &point : tradeoff.points)
    point.pareto = false;
  const int without_front = coloured_pixels(draw_tradeoff(tradeoff));
  tradeoff.points.clear();
  CHECK(coloured_pixels(draw_tradeoff(tradeoff)) == 0);
  CHECK(without_front > 100);
  CHECK(with_front > without_front + 300);                               // the line of the samples' front
  tradeoff.points = {measured(Sweep::modes, Mode::automatic, 1.0, 0.0)}; // an error of 0
  CHECK(coloured_pixels(draw_tradeoff(tradeoff)) > 50);
}
