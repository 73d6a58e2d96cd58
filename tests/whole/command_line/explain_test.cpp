// `pmdsim explain` and `pmdsim schema`, by the real binary, and the page that is made of them.

#include "tests/program/refusal.h"
#include "tests/whole/command_line/run_fixture.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

std::string output_of(const std::vector<std::string> &arguments) {
  const Run run = run_pmdsim(arguments);
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  CHECK(run.errors.empty());
  return run.output;
}

bool holds(const std::string &text, const std::string &part) { return text.find(part) != std::string::npos; }

std::vector<std::string> paths_of(const std::string &words) {
  std::vector<std::string> paths;
  const json explained = json::parse(output_of({"explain", words, "--json"}));
  for (const json &key : explained.at("keys"))
    paths.push_back(key.at("path"));
  return paths;
}

} // namespace

TEST_CASE("a key is explained by its name and by its path", "[smoke]") {
  const std::string text = output_of({"explain", "focal_length_m"});
  for (const char *part :
       {"sensors/*/focal_length_m", "a number from 1e-09 to 1000", "metres", "it has to be there",
        "\"focal_length_m\": 0.004", "--set sensors/0/focal_length_m=0.004"})
    CHECK(holds(text, part));
  const std::vector<std::string> taps{"sensors/*/taps"};
  for (const char *words :
       {"taps", "sensors/0/taps", "/sensors/0/taps", "sensors/*/taps", "sensors/pmd/taps"})
    CHECK(paths_of(words) == taps);
  CHECK(paths_of("/sensors/*/waveform") == std::vector<std::string>{"sensors/*/waveform"});
  CHECK(paths_of("sensors/0") == std::vector<std::string>{"sensors"});
  CHECK(paths_of("resolution/1") == std::vector<std::string>{"sensors/*/resolution"});
  CHECK(paths_of("pose").size() == 3);
  CHECK(paths_of("distortion/k1").size() == 2); // of either model
  CHECK(holds(output_of({"explain", "shadows"}), "\"auto\" or \"off\""));
}

TEST_CASE("channels and exit codes are explained") {
  CHECK(holds(output_of({"explain", "multipath_m"}), "channel that render writes"));
  CHECK(holds(output_of({"explain", "f1.tap_a_e3"}), "tap_a_e0, tap_a_e1"));
  CHECK(holds(output_of({"explain", "deformation_mm"}), "deform"));
  for (const char *channel : {"status", "correction_mm", "normal_error_mm"})
    CHECK(holds(output_of({"explain", channel}), "channel that correct writes"));
  const std::string ranges = output_of({"explain", "range_m"});
  CHECK(holds(ranges, "channel that render writes"));
  CHECK(holds(ranges, "channel that correct writes"));
  CHECK(holds(output_of({"explain", "exit", "8"}), "exit 8"));
  CHECK(output_of({"explain", "exit 8"}) == output_of({"explain", "8"}));
  CHECK(holds(output_of({"explain", "exit"}), "exit 130"));
  CHECK(holds(output_of({"explain", "nothing-in-view"}), "code of a warning"));
  const json both = json::parse(output_of({"explain", "taps", "lit", "exit", "3", "--json"}));
  CHECK(both["keys"].size() == 1);
  CHECK(both["channels"].size() == 1);
  CHECK(both["exit_codes"][0]["code"] == 3);
}

TEST_CASE("without a key all are listed, a line each") {
  const std::string list = output_of({"explain"});
  for (const char *part : {"sensors/*/electronics/full_well_e", "illuminators/*/diodes/rings/*/radius_m",
                           "multipath_m", "exit 130"})
    CHECK(holds(list, part));
  CHECK(std::ranges::count(list, '\n') > 130);
  const json all = json::parse(output_of({"explain", "--json"}));
  CHECK(all["exit_codes"].size() == 11);
}

TEST_CASE("words that mean nothing are answered with what comes near") {
  check_refusal(run_pmdsim({"explain", "focal_lenght_m"}), 2, {"focal_lenght_m", "focal_length_m"});
  check_refusal(run_pmdsim({"explain", "modulation"}), 2, {"modulation_hz", "modulation_phase_deg"});
  check_refusal(run_pmdsim({"explain", "xyzzy"}), 2, {"xyzzy", "`pmdsim explain` lists all"});
  check_refusal(run_pmdsim({"explain", ""}), 2, {"explain"});
  check_refusal(run_pmdsim({"explain", "99"}), 2, {"99"});
  check_refusal(run_pmdsim({"explain", "taps", "--markdown"}), 2, {"--markdown"});
}

TEST_CASE("every example of a key is one that the key takes") {
  const json keys = json::parse(output_of({"explain", "--json"})).at("keys");
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  for (const json &key : keys) {
    const std::string path = key.at("path");
    INFO(path << " = " << key.at("example"));
    CHECK_FALSE(key.at("example").is_null());
    CHECK(std::ranges::count(key.at("about").get<std::string>(), ' ') > 2);
    CHECK((key.at("about").get<std::string>().ends_with('.') || path.ends_with("/*")));
    // What is at the top, and numbers and words of a sensor and an illuminator, can be put into any setup.
    const bool is_plain = std::ranges::count(path, '/') == 2 && !path.starts_with("nodes") &&
                          (key.at("example").is_primitive() || key.at("example").is_array()) &&
                          !key.contains("beside");
    const bool needs_more =
        path.ends_with("unwrap_range_m") || path.ends_with("/name") || path == "illuminators/*/modulation_hz";
    if (!is_plain || needs_more)
      continue;
    std::string at = path;
    at.replace(at.find('*'), 1, "0");
    const Run run = run_pmdsim({"check", setup, "--set", at + "=" + key.at("example").dump()});
    INFO(run.errors);
    CHECK((run.exit_code == 0 || !holds(run.errors, ": expected a"))); // 3 where other keys have to fit
  }
}

TEST_CASE("docs/reference.md is what the program says") {
  CHECK(bytes_in(PMDSIM_SCENES "/../docs/reference.md") == output_of({"explain", "--markdown"}));
}

TEST_CASE("schema prints the JSON Schema of setups") {
  const std::string schema = output_of({"schema"});
  CHECK(json::parse(schema)["properties"].contains("sensors"));
  CHECK(schema == bytes_in(PMDSIM_SCENES "/../host/input/setup/setup.schema.json"));
  const Workspace work;
  CHECK(output_of({"schema", "-o", work / "schema.json"}).empty());
  CHECK(bytes_in(work / "schema.json") == schema);
  CHECK(json::parse(output_of({"schema", "-o", work / "schema.json", "--json"}))["outputs"][0] ==
        work / "schema.json");
  check_refusal(run_pmdsim({"schema", "-o", work / "none/schema.json"}), 7, {"none/schema.json"});
}

TEST_CASE("a setup may name its schema, which changes nothing") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write(
      "setup.json", with(small_setup(), "\"scene\"", "\"$schema\": \"elsewhere.json\", \"scene\""));
  const Run run = run_pmdsim({"render", setup, "-o", work / "out", "--device", "reference"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  CHECK_FALSE(json::parse(bytes_in(work / "out/manifest.json"))["setup"].contains("$schema"));
  // The same run, as which it is resumed.
  work.write("setup.json", small_setup());
  CHECK(run_pmdsim({"render", setup, "-o", work / "out", "--device", "reference", "--resume"}).exit_code ==
        0);
  work.write("setup.json", with(small_setup(), "\"scene\"", "\"$schema\": 1, \"scene\""));
  check_refusal(run_pmdsim({"check", setup}), 3, {"$schema"});
}
