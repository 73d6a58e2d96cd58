// `diodes` on the real binary: its figures and files, and what it refuses.

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

std::string written_setup(const Workspace &work, const std::string &text = small_setup()) {
  work.write("wall.gltf", wall_gltf());
  return work.write("setup.json", text);
}

json study(const Workspace &work, const std::string &setup, const std::vector<std::string> &more = {}) {
  std::vector<std::string> arguments{"diodes", setup, "-o", work / "out", "--json", "--boards", "200"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Run run = run_pmdsim(arguments);
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.output);
}

std::string text_of_file(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  REQUIRE(in);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t lines_of(const std::string &file) { return std::ranges::count(text_of_file(file), '\n'); }

const std::string ring = R"("diodes": {"rings": [{"radius_m": 0.146, "count": 16}]})";

} // namespace

TEST_CASE("diodes writes tables and pictures, and says the same for people and scripts") {
  const Workspace work;
  const std::string setup = written_setup(work);
  const json report = study(work, setup);
  CHECK(work.files("out") == std::vector<std::string>{"alike.csv", "board.csv", "diodes.csv", "diodes.png",
                                                      "pixels.csv", "study.json", "study.txt",
                                                      "tolerance_map.png", "tolerance_map_varying.png"});
  CHECK(report["outputs"].size() == 9);
  CHECK(report["diodes"].size() == 16);
  CHECK(lines_of(work / "out/diodes.csv") == 17);
  CHECK(lines_of(work / "out/board.csv") == 7);
  CHECK(lines_of(work / "out/alike.csv") == 8);
  CHECK(lines_of(work / "out/pixels.csv") == 1 + static_cast<std::ptrdiff_t>(report["boards_pixels"]));
  const json file = json::parse(text_of_file(work / "out/study.json"));
  CHECK(file["setup"]["sensors"][0]["name"] == "pmd");
  CHECK(file["board"] == report["board"]);
  const Run people = run_pmdsim({"diodes", setup, "-o", work / "out", "--boards", "200"});
  const std::string written = text_of_file(work / "out/study.txt");
  CHECK(written.starts_with(setup + "\n\nsensor pmd at 20 MHz"));
  CHECK(people.output.starts_with(written.substr(written.find("sensor pmd"))));
  CHECK(written.find("The diodes are isotropic") != std::string::npos);
  CHECK(people.exit_code == 0);
  CHECK(people.errors.empty());
  for (const char *text : {"16 diodes", "dead", "all of these", "diodes that matter most",
                           "The tolerance that dominates is phase (1 deg)", "tolerance_map.png"}) {
    INFO(text);
    CHECK(people.output.find(text) != std::string::npos);
  }
}

TEST_CASE("the tolerances that are written are those that are told and studied") {
  const Workspace work;
  const std::string setup = written_setup(work);
  const json report = study(work, setup,
                            {"--position", "200um", "--axis", "0deg", "--intensity", "10%", "--phase",
                             "0.01rad", "--dead", "0%", "--law", "uniform", "--seed", "7"});
  const json &tolerances = report["tolerances"];
  CHECK(tolerances["position_m"].get<double>() == Approx(2e-4));
  CHECK(tolerances["axis_deg"] == 0.0);
  CHECK(tolerances["intensity"].get<double>() == Approx(0.1));
  CHECK(tolerances["phase_deg"].get<double>() == Approx(0.5729577951));
  CHECK(tolerances["dead"] == 0.0);
  CHECK(tolerances["law"] == "uniform");
  CHECK(report["seed"] == 7);
  CHECK(report["board"][1]["linear_rms_um"] == 0.0);
  CHECK(report["board"][4]["linear_rms_um"] == 0.0);
  const json usual = study(work, setup);
  // Twice the displacement: twice the change; evenly distributed: a third of the variance.
  CHECK(report["diodes"][3]["z"]["rms_um"].get<double>() ==
        Approx(2.0 * usual["diodes"][3]["z"]["rms_um"].get<double>()));
  CHECK(report["board"][0]["linear_rms_um"].get<double>() ==
        Approx(2.0 / std::sqrt(3.0) * usual["board"][0]["linear_rms_um"].get<double>()));
}

TEST_CASE("the same seed gives the same files, another seed other boards") {
  const Workspace work;
  const std::string setup = written_setup(work);
  study(work, setup);
  const std::string diodes = text_of_file(work / "out/diodes.csv"),
                    board = text_of_file(work / "out/board.csv");
  study(work, setup);
  CHECK(text_of_file(work / "out/board.csv") == board);
  study(work, setup, {"--seed", "1"});
  CHECK(text_of_file(work / "out/board.csv") != board);
  CHECK(text_of_file(work / "out/diodes.csv") == diodes);
}

TEST_CASE("one diode, light in the lens and several illuminators are studied, too") {
  const Workspace work;
  json report = study(work, written_setup(work, with(small_setup(), ring, R"("diodes": "monostatic")")));
  REQUIRE(report["diodes"].size() == 1);
  CHECK(report["diodes"][0]["light_share"] == 1.0);
  CHECK(report["diodes"][0]["dead"]["rms_um"].is_null());
  CHECK(report["diodes"][0]["left_dark"] == report["lit_pixels"]);
  CHECK(report["diodes"][0]["z"]["rms_um"].get<double>() == Approx(50.0).epsilon(0.01));

  const std::string two = with(small_setup(), ring + "\n  }]", ring + R"(}, {
    "name": "lamp", "pose": {"position_m": [0.5, 0, 0], "look_at_m": [0, 0, -2]}, "diodes": "monostatic",
    "modulation_phase_deg": 45}])");
  report = study(work, written_setup(work, two));
  CHECK(report["diodes"].size() == 17);
  CHECK(report["diodes"][16]["illuminator"] == "lamp");
  CHECK(report["alike"].size() == 14);
}

TEST_CASE("bad tolerances are refused in a line that says what was expected") {
  const Workspace work;
  const std::string setup = written_setup(work);
  struct Case {
    std::string option, value, expected;
  };
  for (const auto &[option, value, expected] : std::vector<Case>{
           {"--position", "-0.1mm", "--position: expected a length from 0 to 1 m with its unit"},
           {"--position", "0.1", "unit, m, mm or um"},
           {"--position", "nanmm", "\"nanmm\""},
           {"--position", "0.1inch", "\"0.1inch\""},
           {"--position", "2m", "from 0 to 1 m"},
           {"--axis", "1", "deg or rad"},
           {"--axis", "91deg", "from 0 to 90 degrees"},
           {"--intensity", "0.05", "with its sign"},
           {"--intensity", "101%", "from 0% to 100%"},
           {"--phase", "infdeg", "from 0 to 180 degrees"},
           {"--dead", "60%", "from 0% to 50%"},
           {"--dead", "-1%", "from 0% to 50%"},
           {"--law", "normal", "--law"},
           {"--boards", "99", "--boards: expected a whole number from 100 to 100000"},
           {"--boards", "1e3", "\"1e3\""},
           {"--seed", "-1", "--seed: expected a whole number"},
           {"--pixels", "0", "--pixels: expected a whole number from 1 to 1024"},
           {"--sensor", "nobody", "--sensor: expected the name of a sensor"},
       }) {
    INFO(option << " " << value);
    check_refusal(run_pmdsim({"diodes", setup, "-o", work / "out", option + "=" + value}), 2, {expected});
    CHECK(!std::filesystem::exists(work / "out"));
  }
}

TEST_CASE("a setup without light that returns is refused, and leaves nothing behind") {
  const Workspace work;
  const std::string away = with(small_setup(), R"("pose": {"sensor": "pmd"})",
                                R"("pose": {"position_m": [0, 0, -4], "look_at_m": [0, 0, -9]})");
  check_refusal(run_pmdsim({"diodes", written_setup(work, away), "-o", work / "out"}), 3,
                {"setup.json: sensor pmd: expected pixels that light returns to"});
  CHECK(!std::filesystem::exists(work / "out"));
}

TEST_CASE("random boards stand for the image where few pixels, at the rim of a ball, rule it") {
  const Workspace work;
  REQUIRE(run_pmdsim({"new", "ball", work / "ball"}).exit_code == 0);
  for (const char *pixels : {"64", "110", "160"}) {
    const json report = study(work, work / "ball/setup.json", {"--pixels", pixels});
    INFO(pixels << " pixels");
    CHECK(report["boards_pixels"] > 80);
    CHECK(report["boards_pixels"] <= 100);
    for (const json &row : report["board"]) {
      INFO(row["errors"]);
      CHECK(row["linear_rms_there_um"].get<double>() ==
            Catch::Detail::Approx(row["linear_rms_um"].get<double>()).epsilon(0.15));
      CHECK(row["linear_varying_rms_there_um"].get<double>() ==
            Catch::Detail::Approx(row["linear_varying_rms_um"].get<double>()).epsilon(0.15));
    }
  }
}
