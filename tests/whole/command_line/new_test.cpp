// `pmdsim new`, by the real binary: what it writes is valid without a warning, and measures well.

#include "tests/program/refusal.h"
#include "tests/whole/command_line/run_fixture.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

const std::vector<std::string> kinds{"room",         "ring", "wall",   "step",  "star",
                                     "checkerboard", "ball", "corner", "target"};

Run new_setup(const Workspace &work, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "new");
  return run_pmdsim(arguments, {.directory = work.path()});
}

json made_json(const Run &run) {
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.output);
}

// Checks that the setup is valid and that nothing is said against it.
void check_sound(const std::string &setup) {
  const Run run = run_pmdsim({"check", setup, "--json"});
  INFO(setup << ": " << run.errors);
  REQUIRE(run.exit_code == 0);
  CHECK(run.errors.empty());
  const json report = json::parse(run.output);
  CHECK(report["warnings"].empty());
  CHECK(report["sensors"][0]["share_beyond_ambiguity"][0] == 0.0);
}

} // namespace

TEST_CASE("every kind of new setup is valid without a warning", "[smoke]") {
  const Workspace work;
  for (const std::string &kind : kinds) {
    const json made = made_json(new_setup(work, {kind, "--json"}));
    CHECK(made["kind"] == (kind == "target" ? "star" : kind));
    CHECK(made["setup"] == kind + "/setup.json");
    for (const std::string file : made["outputs"])
      CHECK(std::filesystem::is_regular_file(work / file));
    check_sound(work / (kind + "/setup.json"));
  }
}

TEST_CASE("every new setup shows what it is for") {
  const Workspace work;
  for (const std::string &kind : kinds) {
    made_json(new_setup(work, {kind, "--json"}));
    const std::string out = work / (kind + "/out");
    const Run run = run_pmdsim({"render", work / (kind + "/setup.json"), "-o", out, "--format", "csv,png",
                                "--set", "sensors/0/samples=1"});
    INFO(kind << ": " << run.errors);
    REQUIRE(run.exit_code == 0);
    CHECK(run.errors.empty());
    CHECK(run.output.find("100.00 % of the samples hit the scene") != std::string::npos);
    CHECK(std::filesystem::file_size(out + "/camera_0000.amplitude.png") > 4000); // more than one colour
  }
}

TEST_CASE("the paper's ring is that of scenes/") {
  const Workspace work;
  made_json(new_setup(work, {"ring", "--json"}));
  const auto deformation = [&](const std::string &setup) {
    return made_json(run_pmdsim({"deform", setup, "--json", "-o", work / "out"}))["deformation_mm"];
  };
  const json ours = deformation(work / "ring/setup.json"), theirs = deformation(scene("paper_ring.json"));
  for (const char *figure : {"mean", "min", "max", "centre"})
    CHECK(ours[figure].get<double>() == Approx(theirs[figure].get<double>()).margin(1e-4));
}

TEST_CASE("distance, size and what a target is made of can be chosen") {
  const Workspace work;
  made_json(new_setup(work, {"wall", "near", "--distance-m", "0.5", "--size-m", "1", "--json"}));
  made_json(new_setup(work, {"wall", "far", "--distance-m", "60", "--json"}));
  made_json(new_setup(work, {"step", "--depth-m", "0.25", "--json"}));
  made_json(new_setup(work, {"star", "--spokes", "5", "--json"}));
  made_json(new_setup(work, {"checkerboard", "--squares", "4", "--json"}));
  made_json(new_setup(work, {"ball", "--size-m", "0.3", "--json"}));
  for (const char *folder : {"near", "far", "step", "star", "checkerboard", "ball"})
    check_sound(work / (std::string(folder) + "/setup.json"));
  const auto visible_m = [&](const std::string &folder) {
    return made_json(run_pmdsim({"check", work / (folder + "/setup.json"), "--json"}))["visible_range_m"][0];
  };
  CHECK(visible_m("near").get<double>() == Approx(0.5).margin(1e-3));
  CHECK(visible_m("far").get<double>() == Approx(60.0).margin(0.05)); // and at a frequency that does not wrap
  CHECK(visible_m("ball").get<double>() == Approx(2.0 - 0.15).margin(5e-3));
  CHECK(bytes_in(work / "star/scene.gltf").find("dark_spokes") != std::string::npos);
}

TEST_CASE("the diodes of the room are in its table, too") {
  const Workspace work;
  made_json(new_setup(work, {"room", "--json"}));
  const std::string rings = bytes_in(work / "room/setup.json");
  const std::string table =
      with(with(rings, R"({"rings": [{"radius_m": 0.05, "count": 24}]})", R"({"file": "diodes.csv"})"),
           R"("pattern": {"order": 1},)", "");
  work.write("room/table.json", table);
  const auto report = [&](const std::string &setup) {
    return made_json(run_pmdsim({"render", work / setup, "-o", work / "out", "--format", "csv", "--json"}));
  };
  const json one = report("room/setup.json"), other = report("room/table.json");
  CHECK(one["frames"][0]["outputs"] == other["frames"][0]["outputs"]);
  CHECK(
      made_json(run_pmdsim({"check", work / "room/table.json", "--json"}))["power_w"].get<double>() ==
      Approx(made_json(run_pmdsim({"check", work / "room/setup.json", "--json"}))["power_w"].get<double>()));
}

TEST_CASE("what is printed next works, whatever the folder's name") {
  const Workspace work;
  for (const std::string folder : {"two words", "äöü ☃", "it's", "-dash", "$HOME"}) {
    const json made = made_json(folder.starts_with('-') ? new_setup(work, {"wall", "--json", "--", folder})
                                                        : new_setup(work, {"wall", folder, "--json"}));
    for (const std::string command : made["next"]) {
      REQUIRE(command.starts_with("pmdsim "));
      const std::string line = "cd '" + work.path().string() + "' && '" PMDSIM_PROGRAM "' " +
                               command.substr(7) + " >/dev/null 2>&1";
      INFO(line);
      CHECK(std::system(line.c_str()) == 0);
    }
    CHECK(std::filesystem::is_regular_file(work.path() / folder / "out" / "camera_0000.exr"));
  }
}

TEST_CASE("nothing that is there is replaced unless that is asked for") {
  const Workspace work;
  made_json(new_setup(work, {"room", "--json"}));
  work.write("room/setup.json", "mine");
  work.write("room/notes.txt", "mine");
  check_refusal(new_setup(work, {"room"}), 7, {"room", "not empty", "--force"});
  CHECK(bytes_in(work / "room/setup.json") == "mine");
  CHECK(new_setup(work, {"room", "--force"}).exit_code == 0);
  CHECK(bytes_in(work / "room/notes.txt") == "mine");
  check_sound(work / "room/setup.json");
  std::filesystem::create_directory(work.path() / "empty");
  work.write("empty/.setup.json.0123abcd.partial", ""); // of one that was killed
  CHECK(new_setup(work, {"wall", "empty/"}).exit_code == 0);
  work.write("file", "");
  check_refusal(new_setup(work, {"wall", "file"}), 7, {"file", "no folder"});
  check_refusal(new_setup(work, {"wall", "file", "--force"}), 7, {"file"});
  check_refusal(new_setup(work, {"wall", "file/below"}), 7, {"file/below"});
  check_refusal(new_setup(work, {"wall", "/proc/pmdsim"}), 7, {"/proc/pmdsim"});
}

TEST_CASE("a folder that cannot be written is left as it is") {
  const Workspace work;
  // A directory of the setup's name cannot be replaced.
  std::filesystem::create_directories(work.path() / "room" / "setup.json");
  check_refusal(new_setup(work, {"room", "--force"}), 7, {"setup.json"});
  CHECK(work.files("room").empty());
  if (::geteuid() != 0) { // root may write anywhere
    std::filesystem::create_directory(work.path() / "closed");
    REQUIRE(::chmod((work / "closed").c_str(), 0500) == 0);
    check_refusal(new_setup(work, {"room", "closed/room"}), 7, {"closed/room"});
  }
}

TEST_CASE("wrong command lines of new") {
  const Workspace work;
  check_refusal(new_setup(work, {"castle"}), 2,
                {"KIND", "castle", "room, ring", "pmdsim new room \"castle\""});
  check_refusal(new_setup(work, {"plane"}), 2, {"KIND", "star, checkerboard"});
  check_refusal(new_setup(work, {"room", "--distance-m", "2"}), 2, {"--distance-m", "room"});
  check_refusal(new_setup(work, {"wall", "--spokes", "7"}), 2, {"--spokes", "wall"});
  check_refusal(new_setup(work, {"star", "--spokes", "1"}), 2, {"--spokes", "2 to 1000"});
  check_refusal(new_setup(work, {"star", "--spokes", "-4"}), 2, {"--spokes"});
  check_refusal(new_setup(work, {"wall", "--distance-m", "nan"}), 2, {"--distance-m", "0.1 to 100"});
  check_refusal(new_setup(work, {"wall", "--distance-m", "near"}), 2, {"--distance-m"});
  check_refusal(new_setup(work, {"ball", "--size-m", "4"}), 2, {"--size-m", "inside the ball"});
  check_refusal(new_setup(work, {"room", "a", "b"}), 2, {"b"});
  CHECK(work.files().empty());
}
