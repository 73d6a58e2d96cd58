// tradeoff on the real binary: its files, its JSON, and how it fails.

#include "tests/program/program.h"
#include "tests/program/refusal.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

std::string content(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  REQUIRE(in);
  return {std::istreambuf_iterator<char>(in), {}};
}

// No other point of the sweep is faster and more accurate than one on the front, and one behind it has such.
void check_front(const json &points, const std::string &sweep) {
  const auto beats = [](const json &a, const json &b) {
    return a["frame_ms"] <= b["frame_ms"] && a["error_max_m"] <= b["error_max_m"] &&
           (a["frame_ms"] < b["frame_ms"] || a["error_max_m"] < b["error_max_m"]);
  };
  std::vector<json> compared;
  std::ranges::copy_if(points, std::back_inserter(compared), [&](const json &point) {
    return point["sweep"] == sweep && point["error_max_m"].is_number();
  });
  REQUIRE_FALSE(compared.empty());
  for (const json &point : compared)
    CHECK(point["pareto"] ==
          std::ranges::none_of(compared, [&](const json &other) { return beats(other, point); }));
}

} // namespace

TEST_CASE("tradeoff sweeps modes, precisions and samples, and leaves four whole files") {
  const Workspace work;
  const Run run =
      run_pmdsim({"tradeoff", scene("analytic/inverse_square.json"), "-o", work / "out", "--json"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  CHECK(work.files("out") ==
        std::vector<std::string>{"tradeoff.csv", "tradeoff.json", "tradeoff.md", "tradeoff.png"});
  const json report = json::parse(run.output);
  const json &points = report["points"];
  REQUIRE(points.size() == 17);
  for (const json &point : points) {
    for (const char *key :
         {"mode", "samples", "precision", "frame_ms", "error_max_m", "error_rms_m", "pareto"})
      CHECK(point.contains(key));
    if (!point["refused"].is_null())
      continue;
    CHECK(point["frame_ms_min"] <= point["frame_ms"]);
    CHECK(point["frame_ms"] <= point["frame_ms_max"]);
    CHECK(point["pixels"].get<int>() + point["edge_pixels"].get<int>() == 5);
    CHECK(point["error_max_m"].get<double>() < 1e-6);
  }
  CHECK(std::ranges::count_if(points, [](const json &point) { return point["mode"] == "auto"; }) == 5);
  CHECK(points[16]["samples"] == "auto");
  check_front(points, "modes");
  check_front(points, "samples");
  CHECK(json::parse(content(work / "out/tradeoff.json"))["points"] == points);
  CHECK(std::ranges::count(content(work / "out/tradeoff.csv"), '\n') == 18);
  CHECK(content(work / "out/tradeoff.md").find("\n|---|") != std::string::npos);
  CHECK(content(work / "out/tradeoff.png").starts_with("\x89PNG"));
  for (const std::string output : report["outputs"])
    CHECK(std::filesystem::is_regular_file(output));
}

TEST_CASE("tradeoff prints its tables and where its files are", "[long]") {
  const Workspace work;
  const Run run =
      run_pmdsim({"tradeoff", scene("analytic/on_axis_baseline.json"), "-o", work / "out", "--samples", "2"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  CHECK(run.output.find("modes and precisions: ") != std::string::npos);
  CHECK(run.output.find("reference in double, S = 2") != std::string::npos);
  CHECK(run.output.find("reference in double, S = 16") != std::string::npos);
  CHECK(run.output.find(work / "out/tradeoff.png") != std::string::npos);
}

TEST_CASE("tradeoff fails as the other commands do and leaves nothing") {
  const Workspace work;
  check_refusal(run_pmdsim({"tradeoff", work / "missing.json", "-o", work / "out"}), 3, {"missing.json"});
  check_refusal(run_pmdsim({"tradeoff", scene("paper_ring.json"), "--device", "reference"}), 2,
                {"--device reference"});
  check_refusal(run_pmdsim({"tradeoff", scene("paper_ring.json"), "--device", "no such", "-o", work / "out"}),
                4, {"no such"});
  const Run run =
      run_pmdsim({"tradeoff", scene("room.json"), "-o", work / "out"}, {.interrupt_after_ms = 1500});
  CHECK(run.exit_code == 130);
  CHECK(work.files("out").empty());
  work.write("file", "");
  check_refusal(run_pmdsim({"tradeoff", scene("analytic/inverse_square.json"), "-o", work / "file"}), 7,
                {"file"});
}
