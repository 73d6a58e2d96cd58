// Runs that are killed and go on, and several processes at one run in one folder.

#include "tests/program/refusal.h"
#include "tests/whole/command_line/run_fixture.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <random>
#include <regex>
#include <thread>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

constexpr int slow = 4; // S of S x S samples: a few milliseconds a frame

// Kills the run so many times, each after a random share of the time that it takes, and lets it go on; then
// lets it end. What was whole stays as it was.
void check_killed(int frames, int kills, unsigned seed, const std::string &command = "render") {
  const ManyFrames many(frames, slow);
  const auto start = std::chrono::steady_clock::now();
  many.run_well("undisturbed", {}, command);
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - start;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.5 / kills);
  for (int i = 0; i < kills; ++i) {
    INFO("kill " << i << " of seed " << seed);
    const auto before = many.whole_files("killed");
    RunningPmdsim program(many.arguments("killed", {"--resume"}, command));
    // After the time that a run takes to begin, a little of what is left.
    std::this_thread::sleep_for(std::chrono::milliseconds(30) + whole * share(random));
    program.send(SIGKILL);
    program.wait();
    const auto after = many.whole_files("killed");
    for (const auto &[name, state] : before)
      if (after.at(name) != state)
        FAIL(name << " was made again");
  }
  const auto before = many.whole_files("killed");
  many.run_well("killed", {"--resume"}, command);
  const auto after = many.whole_files("killed");
  CHECK(std::ranges::all_of(before, [&](const auto &file) { return after.at(file.first) == file.second; }));
  many.check_same("killed", "undisturbed");
}

std::size_t number_before(const std::string &text, const std::string &what) {
  std::smatch match;
  return std::regex_search(text, match, std::regex("(\\d+) frames? (was|were) " + what))
             ? std::stoul(match[1])
             : 0;
}

// Lets so many processes make a run of so many frames together; each begins while the first is at it.
void check_together(int processes, int frames) {
  const ManyFrames many(frames, slow);
  many.run_well("alone");
  std::deque<RunningPmdsim> running;
  running.emplace_back(many.arguments("together"));
  wait_for(many.work / "together/run.json");
  while (running.size() < static_cast<std::size_t>(processes))
    running.emplace_back(many.arguments("together"));
  std::size_t made = 0;
  for (RunningPmdsim &program : running) {
    const Run run = program.wait();
    INFO(run.errors << run.output);
    REQUIRE(run.exit_code == 0);
    made += static_cast<std::size_t>(frames) - number_before(run.output, "there before") -
            number_before(run.output, "made by other processes");
  }
  CHECK(made == static_cast<std::size_t>(frames)); // each once
  many.check_same("together", "alone");
}

} // namespace

TEST_CASE("a run that is killed goes on where it was, and ends as if nothing had been") {
  check_killed(24, 4, 1);
}

TEST_CASE("a deform run that is killed goes on, too") { check_killed(12, 2, 2, "deform"); }

TEST_CASE("a run that is killed fifty times ends as if nothing had been", "[long]") {
  check_killed(200, 50, 3);
}

TEST_CASE("two processes share the work in one folder") { check_together(2, 30); }

TEST_CASE("three processes share the work in one folder, again and again", "[long]") {
  for (int i = 0; i < 5; ++i)
    check_together(3, 40);
}

TEST_CASE("what a killed process has left is made by one that lives beside it") {
  const ManyFrames many(30, slow);
  many.run_well("alone");
  RunningPmdsim killed(many.arguments("beside"));
  wait_for(many.work / "beside/run.json");
  RunningPmdsim living(many.arguments("beside"));
  wait_for(many.record("beside", 5));
  killed.send(SIGKILL);
  CHECK(killed.wait().exit_code == 128 + SIGKILL);
  CHECK(living.wait().exit_code == 0);
  many.check_same("beside", "alone");
}

TEST_CASE("without --resume a run that is there is made again, with it nothing is left to do") {
  const ManyFrames three(3);
  three.run_well("out");
  const auto before = three.whole_files("out");
  const Run resumed = three.run("out", {"--resume"});
  CHECK(resumed.exit_code == 0);
  CHECK(resumed.output.find("3 frames were there before") != std::string::npos);
  CHECK(three.whole_files("out") == before);
  const Run again = three.run("out");
  CHECK(again.output.find("there before") == std::string::npos);
  const auto after = three.whole_files("out");
  CHECK(std::ranges::none_of(before, [&](const auto &file) { return after.at(file.first) == file.second; }));
  CHECK(three.run("new", {"--resume"}).exit_code == 0);
  three.check_same("new", "out");
}

TEST_CASE("--resume makes frames whose files are missing or of another size, and tells of all in JSON") {
  const ManyFrames four(4);
  const std::string command = GENERATE("render", "deform");
  four.run_well("alone", {}, command);
  four.run_well("out", {}, command);
  const auto before = four.whole_files("out");
  std::filesystem::remove(four.work / "out/pmd_0001.range_m.npy");
  std::ofstream(four.work / "out/second_0003.exr", std::ios::app) << "more";
  const Run run = four.run("out", {"--resume", "--json"}, command);
  REQUIRE(run.exit_code == 0);
  const json report = json::parse(run.output);
  CHECK(report["frames"].size() == 8);
  if (command == "deform") {
    CHECK(report["deformation_mm"] == report["frames"][0]["deformation_mm"][0]);
    CHECK(report["outputs"].back() == four.work / "out/manifest.json");
  } else {
    CHECK(report["frames"][7]["outputs"][0] == four.work / "out/second_0003.exr");
    CHECK(report["frames"][0].contains("frame_ms"));
  }
  four.check_same("out", "alone");
  for (const auto &[name, state] : four.whole_files("out")) {
    INFO(name);
    const bool made_again = name.find("0001") != std::string::npos || name.find("0003") != std::string::npos;
    CHECK((before.at(name) != state) == made_again);
  }
}

TEST_CASE("a manifest has no frames whose files are missing or of another size") {
  const ManyFrames four(4);
  four.run_well("out");
  std::filesystem::remove(four.work / "out/pmd_0001.range_m.npy");
  std::ofstream(four.work / "out/second_0003.exr", std::ios::app) << "more";
  REQUIRE(run_pmdsim({"merge", four.work / "out"}).exit_code == 0);
  std::vector<int> frames;
  const json manifest = json::parse(bytes_in(four.work / "out/manifest.json"));
  for (const json &frame : manifest["frames"])
    frames.push_back(frame["frame"]);
  CHECK(frames == std::vector<int>{0, 0, 2, 2});
}

TEST_CASE("--resume makes frames again whose records have been edited") {
  const ManyFrames two(2);
  two.run_well("alone");
  two.run_well("out");
  json record = json::parse(bytes_in(two.record("out", 1)));
  record["sensors"][0]["manifest"].erase("time_s");
  std::ofstream(two.record("out", 1)) << record;
  const Run run = two.run("out", {"--resume", "--json"});
  INFO(run.errors);
  CHECK(run.exit_code == 0);
  two.check_same("out", "alone");
}

TEST_CASE("--resume refuses a run's file whose setup or inputs are none") {
  const ManyFrames one(1);
  one.run_well("out");
  auto run = nlohmann::ordered_json::parse(bytes_in(one.work / "out/run.json"));
  std::string expected;
  SECTION("inputs") {
    run["inputs"] = nlohmann::ordered_json::parse(GENERATE(as<std::string>(), "3", "[3]"));
    expected = "its run.json cannot be read";
  }
  SECTION("setup") {
    run["setup"] = 3;
    expected = "its setup differs: 3 there";
  }
  one.work.write("out/run.json", run.dump());
  check_refusal(one.run("out", {"--resume"}), 3, {"--resume: it holds another run: " + expected});
}

TEST_CASE("--resume refuses a folder of another setup, scene, device, option, command or version") {
  const ManyFrames two(2);
  two.run_well("out");
  const auto files = two.work.files("out");
  const auto before = two.whole_files("out");
  const std::string run_file = two.work / "out/run.json";
  std::vector<std::string> more{"--resume"};
  std::string command = "render", difference;
  SECTION("setup") {
    two.work.write("setup.json", with(bytes_in(two.setup), "[30000000.0,50000000.0]", "[30e6,51e6]"));
    difference = "the setup differs at /sensors/1/modulation_hz/1: 50000000 there, 51000000 here";
  }
  SECTION("scene") {
    two.work.write("wall.gltf", with(bytes_in(two.work / "wall.gltf"), "\"wall\"", "\"wale\""));
    difference = "the input file wall.gltf has changed";
  }
  SECTION("samples") {
    more.insert(more.end(), {"--samples", "2"});
    difference = "the setup differs at /sensors/0/samples: 1 there, 2 here";
  }
  SECTION("formats") {
    more.insert(more.end(), {"--format", "png"});
    difference = "its formats differs: ";
  }
  SECTION("command") {
    command = "deform";
    difference = "its command differs: \"render\" there, \"deform\" here";
  }
  SECTION("version") {
    two.work.write("out/run.json", with(bytes_in(run_file), "\"version\": \"", "\"version\": \"0."));
    difference = "its version differs: \"0.";
  }
  std::vector<std::string> arguments = two.arguments("out", {}, command);
  for (const std::string &argument : more) {
    const auto there = std::ranges::find(arguments, argument);
    if (there != arguments.end() && argument != "--resume")
      arguments.erase(there, there + 2);
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  check_refusal(run_pmdsim(arguments), 3, {"--resume: it holds another run: ", difference});
  CHECK(two.work.files("out") == files);
  CHECK(two.whole_files("out") == before);
}

TEST_CASE("a folder where another run is written is refused, and the run goes on") {
  const ManyFrames endless(100000);
  RunningPmdsim living(endless.arguments("out"));
  wait_for(endless.record("out", 0));
  const Run other =
      endless.run("out", {"--frames", "0:1", "--mode", "exact", "--precision", "fp64", "--paths"});
  CHECK(other.exit_code == 2); // a mistake stays one
  endless.work.write("setup.json", with(bytes_in(endless.setup), "\"second\"", "\"third\""));
  check_refusal(endless.run("out"), 7,
                {"another run is being written there", "begun by process", "/sensors/1/name"});
  living.send(SIGINT);
  CHECK(living.wait().exit_code == 130);
}

TEST_CASE("the same files elsewhere are the same run") {
  const ManyFrames two(2), elsewhere(2);
  two.run_well("out");
  std::filesystem::copy(two.work / "out", elsewhere.work / "out");
  const Run run = elsewhere.run("out", {"--resume"});
  INFO(run.errors);
  CHECK(run.exit_code == 0);
  CHECK(run.output.find("2 frames were there before") != std::string::npos);
}
