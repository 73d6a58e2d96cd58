// Frames over time: what is published when, and what is left where a run ends early.

#include "tests/program/program.h"
#include "tests/program/refusal.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

// small_setup() with `frames` frames from 2 s on, 10 a second.
struct Frames {
  Workspace work;
  std::string setup;

  explicit Frames(int frames) {
    work.write("wall.gltf", wall_gltf());
    setup = work.write("setup.json", with(small_setup(), "\"sensors\":",
                                          R"("frames": {"start_s": 2, "rate_hz": 10, "count": )" +
                                              std::to_string(frames) + "}, \"sensors\":"));
  }

  std::vector<std::string> arguments(const std::string &command,
                                     const std::vector<std::string> &more = {}) const {
    std::vector<std::string> all{command,    setup, "--device", "reference",
                                 "--format", "exr", "-o",       work / "out"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  json report(const std::string &command, const std::vector<std::string> &more = {}) const {
    std::vector<std::string> with_json = arguments(command, more);
    with_json.emplace_back("--json");
    const Run run = run_pmdsim(with_json);
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
    return json::parse(run.output);
  }

  json manifest() const {
    std::ifstream in(work / "out/manifest.json");
    return json::parse(in);
  }

  // The directory holds what the manifest lists, a record of each frame, the run's file and the manifest;
  // returns how many frames these are.
  std::size_t check_consistent() const {
    const json frames = manifest()["frames"];
    std::vector<std::string> expected{"manifest.json", "run.json"};
    for (std::size_t i = 0; i < frames.size(); ++i) {
      CHECK(frames[i]["frame"] == i);
      expected.push_back(fmt::format("{:04}.record.json", i));
      std::ranges::copy(frames[i]["outputs"].get<std::vector<std::string>>(), std::back_inserter(expected));
    }
    std::ranges::sort(expected);
    CHECK(work.files("out") == expected);
    return frames.size();
  }
};

bool lists(const json &names, const std::string &name) {
  return std::ranges::find(names, json(name)) != names.end();
}

std::string bytes_of(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  REQUIRE(in);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// The moving things of scenes/motion.json, seen by its sensor, tap by tap, and by another in one exposure.
std::string moving_setup_of_two_sensors() {
  const std::string setup =
      with(bytes_of(scene("motion.json")), "\"moving.gltf\"", "\"" + scene("moving.gltf") + "\"");
  return with(with(setup, "[160, 120]", "[40, 30]"), "\"sensors\": [{", R"("sensors": [{
    "name": "beside",
    "resolution": [30, 40],
    "pixel_pitch_m": [45e-6, 45e-6],
    "focal_length_m": 2e-3,
    "modulation_hz": [20e6, 30e6]
  }, {)");
}

} // namespace

TEST_CASE("all frames of a setup are rendered, each at its time") {
  const Frames three(3);
  const json report = three.report("render");
  REQUIRE(report["frames"].size() == 3);
  CHECK(report["frames"][2]["frame"] == 2);
  CHECK(report["frames"][2]["time_s"].get<double>() == Approx(2.2));
  CHECK(lists(report["frames"][2]["outputs"], three.work / "out/pmd_0002.exr"));
  CHECK(three.check_consistent() == 3);
  const json frame = three.manifest()["frames"][1];
  CHECK(frame["time_s"].get<double>() == Approx(2.1));
  CHECK(frame["tap_interval_s"] == 0.0);
  CHECK(frame["camera"]["world_from_camera"].size() == 4);
  CHECK(three.manifest()["setup"]["frames"]["count"] == 3);
}

TEST_CASE("a range of frames keeps the setup's numbers") {
  const Frames three(3);
  const json frames = three.report("render", {"--frames", "1:3"})["frames"];
  REQUIRE(frames.size() == 2);
  CHECK(frames[0]["frame"] == 1);
  CHECK(frames[0]["time_s"].get<double>() == Approx(2.1));
  CHECK(three.work.files("out") == std::vector<std::string>{"0001.record.json", "0002.record.json",
                                                            "manifest.json", "pmd_0001.exr", "pmd_0002.exr",
                                                            "run.json"});
  const Run run = run_pmdsim(three.arguments("render", {"--frames", "0:2"}));
  CHECK(run.output.find("and the same of frame 1\n") != std::string::npos);
}

TEST_CASE("ranges that are none, and frames that the setup has not") {
  const Frames three(3);
  const std::string range = GENERATE("1", "1:1", "2:1", "-1:2", "0:1:2", "a:b", "0:99999999999", "");
  const std::string command = GENERATE("render", "deform");
  check_refusal(run_pmdsim(three.arguments(command, {"--frames", range})), 2,
                {"--frames: expected A:B", "\"" + range + "\""});
  check_refusal(run_pmdsim(three.arguments(command, {"--frames", "2:4"})), 2,
                {"--frames 2:4: expected B at most 3", "setup.json"});
  CHECK(three.work.files("out").empty());
}

TEST_CASE("deform tells of every frame in JSON and of the first in its table") {
  const Frames two(2);
  const json report = two.report("deform");
  REQUIRE(report["frames"].size() == 2);
  CHECK(report["frames"][1]["time_s"].get<double>() == Approx(2.1));
  CHECK(report["deformation_mm"] == report["frames"][0]["deformation_mm"][0]);
  CHECK(lists(report["outputs"], two.work / "out/pmd_0001.exr"));
  CHECK(two.check_consistent() == 2);
  const std::string text = run_pmdsim(two.arguments("deform")).output;
  CHECK(text.find("\nof frame 0; --json tells of all\n") != std::string::npos);
  const std::string one = run_pmdsim(two.arguments("deform", {"--frames", "1:2"})).output;
  CHECK(one.find("--json") == std::string::npos);
}

TEST_CASE("interrupted midway, whole frames stay and the manifest lists just these") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
  const std::string command = GENERATE("render", "deform");
  const Frames endless(100000);
  const Run run = run_pmdsim(endless.arguments(command),
                             {.signal = signal, .interrupt_when = endless.work / "out/pmd_0001.exr"});
  CHECK(run.exit_code == 130);
  CHECK(run.output.empty());
  CHECK(run.errors.starts_with("pmdsim: error: interrupted; frames 0 to "));
  CHECK(std::ranges::count(run.errors, '\n') == 1);
  const std::size_t frames = endless.check_consistent();
  CHECK(frames >= 2);
  CHECK(frames < 100000);
}

TEST_CASE("under nohup the end of the terminal's session ends nothing") {
  const Frames few(30);
  const Run run =
      run_pmdsim(few.arguments("render"),
                 {.signal = SIGHUP, .interrupt_when = few.work / "out/pmd_0001.exr", .ignored = SIGHUP});
  CHECK(run.exit_code == 0);
  CHECK(few.check_consistent() == 30);
}

TEST_CASE("what fails midway leaves the whole frames before it") {
  const Frames five(5);
  std::filesystem::create_directories(five.work / "out/pmd_0002.exr"); // in the way
  const Run run = run_pmdsim(five.arguments("render"));
  check_refusal(run, 7, {"pmd_0002.exr: cannot be written: Is a directory; frames 0 to 1 are whole"});
  CHECK(five.check_consistent() == 2);
}

TEST_CASE("interrupted while writers are busy, whole frames stay and the manifest lists just these") {
  const Frames endless(100000);
  const std::string large =
      endless.work.write("large.json", with(bytes_of(endless.setup), "[8, 8]", "[512, 512]"));
  const Run run = run_pmdsim({"render", large, "--format", "exr,npy,png", "-o", endless.work / "out"},
                             {.interrupt_when = endless.work / "out/pmd_0001.exr"});
  CHECK(run.exit_code == 130);
  CHECK(run.errors.starts_with("pmdsim: error: interrupted; frames 0 to "));
  CHECK(std::ranges::count(run.errors, '\n') == 1);
  CHECK(endless.check_consistent() >= 2);
}

TEST_CASE("a directory in the way of a file of frame 3 leaves frames 0 to 2, of every format") {
  const Frames eight(8);
  const std::string command = GENERATE("render", "deform");
  std::filesystem::create_directories(eight.work / "out/pmd_0003.z_m.npy");
  const Run run = run_pmdsim({command, eight.setup, "--format", "exr,npy,png,csv", "-o", eight.work / "out"});
  check_refusal(run, 7, {"pmd_0003.z_m.npy: cannot be written: Is a directory; frames 0 to 2 are whole"});
  CHECK(eight.check_consistent() == 3);
}

namespace {

void check_one_by_one(const std::string &command) {
  const Workspace work;
  const std::string setup = work.write("setup.json", moving_setup_of_two_sensors());
  const auto run = [&](const std::string &frames, const std::string &directory) {
    const Run ended = run_pmdsim(
        {command, setup, "--frames", frames, "--format", "exr,npy,png,csv", "-o", work / directory});
    INFO(ended.errors);
    REQUIRE(ended.exit_code == 0);
  };
  run("2:6", "together");
  for (const char *frame : {"2:3", "3:4", "4:5", "5:6"})
    run(frame, "alone");
  const std::vector<std::string> files = work.files("together");
  CHECK(files.size() > 100);
  CHECK(files == work.files("alone"));
  for (const std::string &file : files)
    if (file != "run.json" && !file.ends_with(".record.json")) {
      INFO(file);
      CHECK((bytes_of(work / ("together/" + file)) == bytes_of(work / ("alone/" + file))));
    }
  for (const char *sensor : {"pmd", "beside"}) {
    INFO(sensor);
    const std::string range = std::string("together/") + sensor + "_000";
    CHECK((bytes_of(work / (range + "2.range_m.npy")) != bytes_of(work / (range + "3.range_m.npy"))));
  }
}

} // namespace

TEST_CASE("the frames of a sequence are those that are rendered one by one, bit by bit") {
  check_one_by_one("render");
}

TEST_CASE("the frames that deform takes of a sequence are those of one by one, bit by bit", "[long]") {
  check_one_by_one("deform");
}

TEST_CASE("an earlier run's manifest goes before the first frame comes, even if the run is killed") {
  const Frames endless(100000);
  std::filesystem::create_directory(endless.work / "out");
  endless.work.write("out/manifest.json", "{}");
  const Run run = run_pmdsim(endless.arguments("render"),
                             {.signal = SIGKILL, .interrupt_when = endless.work / "out/pmd_0000.exr"});
  CHECK(run.exit_code == 128 + SIGKILL);
  CHECK(std::ranges::count(endless.work.files("out"), "manifest.json") == 0);
}

TEST_CASE("interrupted before a frame is whole, an earlier run's frames stay, without its manifest") {
  const Workspace work;
  std::filesystem::create_directory(work / "out");
  work.write("out/manifest.json", "{}");
  work.write("out/pmd_0000.exr", "old");
  const Run run = run_pmdsim(
      {"render", scene("paper_ring.json"), "--device", "reference", "--samples", "8", "-o", work / "out"},
      {.interrupt_after_ms = 1000});
  CHECK(run.exit_code == 130);
  CHECK(run.errors == "pmdsim: error: interrupted\n");
  CHECK(work.files("out") == std::vector<std::string>{"pmd_0000.exr"});
}

TEST_CASE("the memory of a run does not grow with its frames") {
  const auto peak_bytes = [](int count) {
    const Frames frames(count);
    const std::string large =
        frames.work.write("large.json", with(bytes_of(frames.setup), "[8, 8]", "[256, 256]"));
    const Run run =
        run_pmdsim({"render", large, "--device", "reference", "--format", "exr", "-o", frames.work / "out"});
    CHECK(run.exit_code == 0);
    return run.peak_resident_bytes;
  };
  // A frame's channels are 3 MiB; no more are held than there are cores, and two.
  const int held = static_cast<int>(std::thread::hardware_concurrency()) + 2;
  // Both runs are long enough to have held as many at once as they ever do.
  CHECK(peak_bytes(held + 30) < peak_bytes(held + 10) + (std::int64_t{12} << 20));
}

TEST_CASE("where nothing moves, taps that take their time are those of one exposure") {
  const Frames frames(1);
  const std::string at_once = frames.setup;
  const std::string in_sequence = frames.work.write(
      "sequence.json",
      with(with(small_setup(), "0.0018,", "0.0018, \"tap_interval_s\": 0.01,"), "[20e6]", "[20e6, 30e6]"));
  const std::string together =
      frames.work.write("together.json", with(small_setup(), "[20e6]", "[20e6, 30e6]"));
  for (const std::string &setup : {in_sequence, together})
    REQUIRE(run_pmdsim({"render", setup, "--format", "npy", "-o",
                        frames.work / (setup == together ? "together" : "sequence")})
                .exit_code == 0);
  for (const char *channel : {"f0.distance_m", "f1.amplitude", "f1.tap3"}) {
    INFO(channel);
    const std::string name = std::string("/pmd_0000.") + channel + ".npy";
    CHECK(bytes_of(frames.work / ("sequence" + name)) == bytes_of(frames.work / ("together" + name)));
  }
}

TEST_CASE("check tells when frames are taken, and how long their taps take") {
  const Frames frames(3);
  const json report = json::parse(run_pmdsim({"check", frames.setup, "--json"}).output);
  CHECK(report["frames"]["count"] == 3);
  CHECK(report["frames"]["rate_hz"] == 10.0);
  CHECK(report["frames"]["span_s"].get<double>() == Approx(0.2));
  CHECK(report["moves"] == false);
  const std::string text = run_pmdsim({"check", frames.setup}).output;
  CHECK(text.find(" 3 at 10 Hz, from 2 s to 2.2 s\n") != std::string::npos);
  const std::string slow = frames.work.write(
      "slow.json", with(bytes_of(frames.setup), "0.0018,", "0.0018, \"tap_interval_s\": 0.03,"));
  const Run run = run_pmdsim({"check", slow});
  CHECK(run.exit_code == 0);
  CHECK(run.output.find("4 one after the other, 0.03 s each, 0.12 s in all\n") != std::string::npos);
  CHECK(
      run.errors.find("sensor pmd: its taps take 0.12 s, longer than the 0.1 s from one frame to the next") !=
      std::string::npos);
}

TEST_CASE("bench times the first of several frames") {
  const Frames frames(3);
  const Run run = run_pmdsim({"bench", frames.setup, "--device", "reference", "--json"});
  REQUIRE(run.exit_code == 0);
  CHECK(json::parse(run.output)["results"].size() == 1);
}
