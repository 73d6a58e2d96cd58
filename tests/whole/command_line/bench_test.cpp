// The output of `bench SETUP --json`. No test looks at how long anything took.

#include "tests/program/program.h"
#include "tests/program/refusal.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
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
    CHECK(row["first_frame_ms"].get<double>() > 0.0);
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
  check_spread(report["accumulate_looped_interactions_per_s"]);
  const double rate = report["accumulate_looped_interactions_per_s"]["median"];
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

TEST_CASE("bench --suite checks and times scenes beside another program") {
  const Workspace work;
  const std::string peer = work.write("peer's.sh", "#!/bin/sh\necho $* > \"$0.said\"\n"
                                                   "echo first frame_ms 9\necho then frame_ms 2.5 ms\n");
  std::filesystem::permissions(peer, std::filesystem::perms::owner_all);
  const Run run = run_pmdsim({"bench", "--suite", "real", "--kinds", "knot", "--triangles", "1000",
                              "--columns", "10", "--against", peer, "--json"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  const json report = json::parse(run.output), &row = report["results"].at(0);
  CHECK(row["name"] == "knot");
  CHECK(row["triangles"].get<int>() == Approx(1000).epsilon(0.15));
  CHECK(row["frames_timed"].get<int>() >= 1);
  CHECK(row["passes_ms"].contains("lit"));
  CHECK(row["first_frame_ms"].get<double>() > 0.0);
  CHECK(row["prepare_ms"].get<double>() > 0.0);
  CHECK(row["path"].is_object());
  const json &check = row["check"];
  CHECK(check["pixels"] == 1);
  CHECK(check["pairs"] == 240);
  CHECK(check["pairs_beyond_rounding"] == 0);
  CHECK(check["distances_off"] == 0);
  CHECK(row["peer"]["frame_ms"]["median"] == 2.5);
  CHECK(row["peer"]["speed_over_peer"].get<double>() == Approx(2.5 / row["frame_ms"].get<double>()));
  std::ifstream said(peer + ".said");
  const std::string words((std::istreambuf_iterator<char>(said)), {});
  CHECK(words.find("knot.gltf ") != std::string::npos);
  CHECK(words.find("--res 10 10 --fov-x-tan 0.5 --freq 20000000 --shadows --threads") != std::string::npos);
}

TEST_CASE("bench --suite writes its scenes, and says what is wrong") {
  const Workspace work;
  const std::vector<std::string> suite{"bench", "--suite", "real", "--triangles", "1000", "--columns", "8"};
  const auto with_words = [&](std::vector<std::string> words) {
    words.insert(words.begin(), suite.begin(), suite.end());
    return run_pmdsim(words);
  };
  REQUIRE(with_words({"--kinds", "blob,soup", "--write-scenes", work / "scenes"}).exit_code == 0);
  CHECK(work.files("scenes") == std::vector<std::string>{"blob_1000.bin", "blob_1000.gltf", "blob_1000.json",
                                                         "diodes.csv", "soup_1000.bin", "soup_1000.gltf",
                                                         "soup_1000.json"});
  CHECK(run_pmdsim({"check", work / "scenes/soup_1000.json"}).exit_code == 0);

  check_refusal(with_words({"--kinds", "blob,fog"}), 2, {"--kinds", "blob, knot", "found fog"});
  check_refusal(with_words({"--kinds", "blob", "--against", work / "nothing"}), 3,
                {"nothing", "cannot be run"});
  check_refusal(with_words({"--kinds", "blob", "--against", "echo"}), 3, {"echo", "frame_ms"});
  check_refusal(run_pmdsim({"bench", "--kinds", "blob"}), 2, {"--kinds", "--suite"});
}
