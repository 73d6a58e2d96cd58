// What `bench SETUP --json` tells. No test looks at how long anything took.

#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

json bench(const std::string &setup, const std::vector<std::string> &more = {},
           const std::map<std::string, std::string> &environment = {}) {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  std::vector<std::string> arguments{"bench", work.write("setup.json", setup), "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Run run = run_pmdsim(arguments, {.environment = environment});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.output);
}

void check_spread(const json &spread) {
  CHECK(spread["min"].get<double>() > 0.0);
  CHECK(spread["median"].get<double>() >= spread["min"].get<double>());
  CHECK(spread["max"].get<double>() >= spread["median"].get<double>());
}

} // namespace

TEST_CASE("bench --json has every figure and what it depends on") {
  const json report = bench(small_setup(), {}, {{"LP_NUM_THREADS", "1"}});
  for (const char *key : {"device", "driver", "processor", "threads", "hardware_threads", "build", "command",
                          "knobs", "passes_by", "results", "ratios", "native", "peak_memory_bytes"}) {
    INFO(key);
    CHECK(report.contains(key));
  }
  CHECK(report["threads"] == 1);
  CHECK(report["knobs"]["environment"]["LP_NUM_THREADS"] == "1");
  CHECK(report["knobs"]["environment"].contains("LP_NATIVE_VECTOR_WIDTH"));
  CHECK(report["knobs"]["environment"].contains("MESA_SHADER_CACHE_DIR"));
  CHECK(report["knobs"]["environment"]["PMDSIM_VALIDATE"] == "1"); // as the tests run
  CHECK(report["knobs"]["samples"] == json{"1 x 1"});
  for (const char *key : {"compiler", "version", "type"})
    CHECK_FALSE(report["build"][key].get<std::string>().empty());
  CHECK((report["passes_by"] == "clock" || report["passes_by"] == "timestamps"));
  CHECK(report["peak_memory_bytes"].get<double>() > 1e6);
  CHECK_FALSE(report.contains("linearity")); // no sweep

  REQUIRE(report["results"].size() == 3);
  for (const json &row : report["results"]) {
    CHECK(row["first_frame_ms"].get<double>() > row["prepare_ms"].get<double>());
    CHECK(row["prepare_ms"].get<double>() > 0.0);
    CHECK(row["frames_timed"] == 7);
    CHECK(row["frame_ms_min"].get<double>() <= row["frame_ms"].get<double>());
    CHECK(row["frame_ms"].get<double>() <= row["frame_ms_max"].get<double>());
    double passes_ms = 0.0;
    for (const json &pass_ms : row["passes_ms"])
      passes_ms += pass_ms.get<double>();
    CHECK(row["passes_explain"].get<double>() > 0.0);
    CHECK(row["passes_explain"].get<double>() < 1.0 + 1e-9);
    CHECK(passes_ms > 0.0);
  }
}

TEST_CASE("bench sets the accumulate pass beside native code in both forms", "[long]") {
  const json report = bench(small_setup());
  const json &native = report["native"], &ratios = report["ratios"];
  CHECK(native["what"] == "the setup's diodes and points");
  CHECK(native["points"] == 64);
  CHECK(native["diodes"] == 16);
  CHECK(native["error_max_m"].get<double>() < 1e-6);
  CHECK(native["series"]["error_max_m"].get<double>() < 3e-6);
  check_spread(native["interactions_per_s"]);
  check_spread(native["series"]["interactions_per_s"]);
  const double rate = report["results"][0]["interactions_per_s"];
  CHECK(ratios["accumulate_over_native"].get<double>() ==
        Approx(rate / native["interactions_per_s"]["median"].get<double>()));
  CHECK(ratios["accumulate_over_native_series"].get<double>() ==
        Approx(rate / native["series"]["interactions_per_s"]["median"].get<double>()));
  CHECK(ratios.contains("exact_frame_over_auto_frame"));
  for (const auto &[name, ratio] : ratios.items())
    check_spread(report["ratios_of_rounds"][name]);
}

TEST_CASE("bench sums other points natively where its kernel is no model of the setup") {
  const json report = bench(with(small_setup(), "constant", "lambert"), {"--mode", "exact"});
  CHECK(report["native"]["what"] ==
        "a ring's diodes and a wall's points, as the backscatter is not constant");
  CHECK(report["native"]["points"] == 640 * 640);
  CHECK(report["native"]["diodes"] == 240);
}

TEST_CASE("bench has no native rate beside what has no rate itself", "[long]") {
  CHECK(bench(small_setup(), {"--mode", "auto"})["native"].is_null());
  CHECK(bench(small_setup(), {"--samples", "auto"})["native"].is_null());
  const json reference = bench(small_setup(), {"--device", "reference"});
  CHECK(reference["native"].is_null());
  CHECK(reference["results"][0]["prepare_ms"].is_null());
}
