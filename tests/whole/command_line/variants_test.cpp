// Setups that the command line changes: one by one, several in one process, and poses from files.

#include "tests/program/program.h"
#include "tests/whole/command_line/run_fixture.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

struct Small {
  Workspace work;
  std::string setup;

  Small() {
    work.write("wall.gltf", wall_gltf());
    setup = work.write("setup.json", small_setup());
  }
  Run render(std::vector<std::string> more) const {
    more.insert(more.begin(), "render");
    more.insert(more.end(), {"--format", "npy"});
    return run_pmdsim(more);
  }
  std::string distance(const std::string &folder, const std::string &frame = "0000") const {
    return bytes_in(work / (folder + "/pmd_" + frame + ".distance_m.npy"));
  }
};

} // namespace

TEST_CASE("A setup that is changed gives the frames of one that is written so") {
  const Small small;
  const std::string written = small.work.write("written.json", with(small_setup(), "[20e6]", "[30e6]"));
  REQUIRE(small.render({written, "-o", small.work / "written"}).exit_code == 0);
  REQUIRE(small.render({small.setup, "--set", "sensors/0/modulation_hz=[30e6]", "-o", small.work / "set"})
              .exit_code == 0);
  CHECK(small.distance("set") == small.distance("written"));
  CHECK(!small.distance("set").empty());
  const json used = json::parse(bytes_in(small.work / "set/manifest.json"))["setup"];
  CHECK(used["sensors"][0]["modulation_hz"] == json::array({30e6}));
}

TEST_CASE("Text need not be quoted, and what is wrong is told as in a file") {
  const Small small;
  const auto check = [&](const std::string &change) {
    return run_pmdsim({"check", small.setup, "--set", change});
  };
  CHECK(check("sensors/pmd/waveform=square").exit_code == 0);
  CHECK(check("sensors/0/waveform=sinus").errors.find("/sensors/0/waveform (by --set): expected") !=
        std::string::npos);
  CHECK(check("sensors/0/waveform=sinus").exit_code == 3);
  CHECK(check("sensors/0/wave=square").errors.find("unknown key \"wave\"") != std::string::npos);
  for (const char *wrong : {"sensors/0/taps", "=4", ""}) {
    CHECK(check(wrong).exit_code == 2);
    CHECK(check(wrong).errors.find("--set: expected PATH=VALUE") != std::string::npos);
  }
  CHECK(run_pmdsim({"check", small.setup, "--set", "a=1", "--set", "/a=2"}).exit_code == 2);
  CHECK(run_pmdsim({"bench", "--set", "a=1"}).exit_code == 2); // there is no setup
  std::string deep = "a";
  for (int i = 0; i < 10'000; ++i)
    deep += "/a";
  CHECK(check(deep + "=1").exit_code == 3);
}

TEST_CASE("Variants: a folder for each, the same bytes as alone, and a table") {
  const Small small;
  const std::string variants = small.work.write("variants.jsonl", R"({"illuminators/0/intensity_w_sr": 2}

{"illuminators/0/intensity_w_sr": 3, "sensors/0/pose": {"position_m": [0, 0, -1], "look_at_m": [0, 0, -2]}}
)");
  const Run run = small.render(
      {small.setup, "--variants", variants, "-o", small.work / "all", "--set", "sensors/0/taps=5"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  REQUIRE(small
              .render({small.setup, "--set", "illuminators/0/intensity_w_sr=3", "--set", "sensors/0/taps=5",
                       "--set", R"(sensors/0/pose={"position_m": [0, 0, -1], "look_at_m": [0, 0, -2]})", "-o",
                       small.work / "alone"})
              .exit_code == 0);
  CHECK(small.distance("all/0001") == small.distance("alone"));
  CHECK(bytes_in(small.work / "all/0001/manifest.json") == bytes_in(small.work / "alone/manifest.json"));
  std::istringstream table(bytes_in(small.work / "all/table.csv"));
  std::string header, first, second, rest;
  std::getline(table, header);
  std::getline(table, first);
  std::getline(table, second);
  CHECK_FALSE(std::getline(table, rest));
  CHECK(header.starts_with(
      "variant,illuminators/0/intensity_w_sr,sensors/0/pose,sensor,frame,time_s,distance_min_m"));
  CHECK(header.find(",range_min_m,range_median_m,range_max_m,coverage_mean") != std::string::npos);
  CHECK(first.starts_with("\"0000\",2,,\"pmd\",0,"));
  CHECK(second.starts_with("\"0001\",3,"));
}

TEST_CASE("Several setups in one process") {
  const Small small;
  const std::string other = small.work.write("other.json", with(small_setup(), "[20e6]", "[60e6]"));
  const Run run = small.render({small.setup, other, "-o", small.work / "both", "--json"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  const json told = json::parse(run.output);
  REQUIRE(told["variants"].size() == 2);
  CHECK(told["variants"][1]["name"] == "other");
  CHECK(told["variants"][1]["frames"][0]["outputs"].size() > 10);
  REQUIRE(small.render({other, "-o", small.work / "alone"}).exit_code == 0);
  CHECK(small.distance("both/other") == small.distance("alone"));
  std::filesystem::create_directory(small.work / "sub");
  const std::string same_name = small.work.write("sub/setup.json", small_setup("../wall.gltf"));
  CHECK(small.render({small.setup, same_name, "-o", small.work / "none"}).exit_code == 2);
}

TEST_CASE("What is wrong with a variant is told before anything is measured") {
  const Small small;
  const auto refused = [&](const std::string &variants) {
    const std::string file = small.work.write("variants.jsonl", variants);
    const Run run = small.render({small.setup, "--variants", file, "-o", small.work / "none"});
    CHECK(run.exit_code == 3);
    CHECK_FALSE(std::filesystem::exists(small.work / "none"));
    return run.errors;
  };
  CHECK(refused("{}\n{\"sensors/0/taps\": 99}\n").find("found 99, in variant 0001") != std::string::npos);
  CHECK(refused("{}\n{\"sensors/7/taps\": 4}\n").find(", in variant 0001") != std::string::npos);
  CHECK(refused("{}\n{\"a\"\n").find("variants.jsonl:2:") != std::string::npos);
  CHECK(refused("{}\n[1]\n").find("variants.jsonl:2: expected an object") != std::string::npos);
  CHECK(refused("\n").find("expected at least one variant") != std::string::npos);
  const std::string file =
      small.work.write("variants.jsonl", "{\"frames\": {\"count\": 2, \"rate_hz\": 1}}\n{}\n");
  const Run run =
      small.render({small.setup, "--variants", file, "-o", small.work / "none", "--frames", "0:2"});
  CHECK(run.exit_code == 2);
  CHECK(run.errors.find(", in variant 0001") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(small.work / "none"));
}

TEST_CASE("A shard of variants") {
  const Small small;
  const std::string variants = small.work.write("variants.jsonl", "{}\n{}\n{}\n");
  REQUIRE(small.render({small.setup, "--variants", variants, "-o", small.work / "shard", "--shard", "1/2"})
              .exit_code == 0);
  CHECK(std::filesystem::exists(small.work / "shard/0001/manifest.json"));
  CHECK_FALSE(std::filesystem::exists(small.work / "shard/0000"));
  CHECK(std::filesystem::exists(small.work / "shard/table.1-of-2.csv")); // the other one's is beside it
  CHECK_FALSE(std::filesystem::exists(small.work / "shard/table.csv"));
  const Run merged = run_pmdsim({"merge", small.work / "shard", "-o", small.work / "all"});
  CHECK(merged.exit_code == 3);
  CHECK(merged.errors.find("it holds variants; `render` with the same options, --resume and no --shard") !=
        std::string::npos);
  REQUIRE(small.render({small.setup, "--variants", variants, "-o", small.work / "none", "--shard", "7/9"})
              .exit_code == 0);
  CHECK_FALSE(std::filesystem::exists(small.work / "none/table.7-of-9.csv"));
}

TEST_CASE("Variants do not go on in the folder of a run without them, and tell of its frames") {
  const Small small;
  const std::string variants = small.work.write("variants.jsonl", "{}\n");
  const std::vector<std::string> study{small.setup, "--variants", variants, "-o", small.work / "one"};
  std::vector<std::string> resumed = study;
  resumed.emplace_back("--resume");
  REQUIRE(small.render({small.setup, "-o", small.work / "one"}).exit_code == 0);
  const Run refused = small.render(resumed);
  CHECK(refused.exit_code == 3);
  CHECK(refused.errors.find("--resume: it holds another run: it has no variants there") != std::string::npos);
  CHECK(std::filesystem::exists(small.work / "one/0000.record.json"));
  const Run told = small.render(study);
  CHECK(told.exit_code == 0);
  CHECK(told.errors.find("1 frame of another run (it has no variants there) stays there") !=
        std::string::npos);
  CHECK(small.render(resumed).exit_code == 0);
}

TEST_CASE("Another study is kept out of the folder, and an interrupted one tells how far it came") {
  const Small small;
  std::string lines, others;
  for (int i = 1; i <= 60; ++i) {
    lines += fmt::format("{{\"illuminators/0/intensity_w_sr\": {}}}\n", i);
    others += fmt::format("{{\"illuminators/0/intensity_w_sr\": {}}}\n", i + 100);
  }
  const std::string variants = small.work.write("variants.jsonl", lines),
                    other = small.work.write("other.jsonl", others);
  const auto arguments = [&](const std::string &file) {
    return std::vector<std::string>{
        "render", small.setup,        "--variants", file, "--set", "sensors/0/resolution=[400, 400]",
        "-o",     small.work / "out", "--format",   "npy"};
  };
  RunningPmdsim running(arguments(variants));
  wait_for(small.work / "out/0001/manifest.json");
  const Run refused = run_pmdsim(arguments(other));
  CHECK(refused.exit_code == 7);
  CHECK(refused.errors.find("out: another run is being written there") != std::string::npos);
  CHECK(refused.errors.find("the setup differs at /illuminators/0/intensity_w_sr: 1 there, 101 here") !=
        std::string::npos);
  const Run plain = small.render({small.setup, "-o", small.work / "out"});
  CHECK(plain.exit_code == 7);
  CHECK(plain.errors.find("it has variants there") != std::string::npos);
  running.send(SIGINT);
  const Run interrupted = running.wait();
  CHECK(interrupted.exit_code == 130);
  CHECK(interrupted.errors.find(" of 60 variants are whole and stay, --resume goes on") != std::string::npos);
  CHECK(std::ranges::count(interrupted.errors, '\n') == 1);
  CHECK_FALSE(std::filesystem::exists(small.work / "out/run.json"));
}

TEST_CASE("Noise that all variants have in common is told of") {
  const Small small;
  const std::string noise =
      R"(sensors/0/electronics={"preset": "kinect_v2_like", "integration_time_s": 1e-3, "lens_f_number": 1.1})";
  const auto output = [&](const std::string &lines) {
    const Run run = small.render({small.setup, "--set", noise, "--variants",
                                  small.work.write("variants.jsonl", lines), "-o", small.work / "out"});
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
    return run.output;
  };
  const std::string told = "The noise of all variants is the same";
  CHECK(output("{}\n{}\n").find(told) != std::string::npos);
  CHECK(output("{\"sensors/0/electronics/seed\": 1}\n{\"sensors/0/electronics/seed\": 2}\n").find(told) ==
        std::string::npos);
}

TEST_CASE("Frames of another run that stay in a folder are told of") {
  const Small small;
  const std::string frames = R"(frames={"count": 3, "rate_hz": 1})";
  REQUIRE(small.render({small.setup, "--set", frames, "-o", small.work / "out"}).exit_code == 0);
  const Run again = small.render({small.setup, "--set", frames, "-o", small.work / "out"});
  CHECK(again.errors.empty()); // the same
  const Run other = small.render({small.setup, "-o", small.work / "out"});
  CHECK(other.exit_code == 0);
  CHECK(other.errors.find("warning: " + small.work / "out" +
                          ": 2 frames of another run (the setup differs at /frames") != std::string::npos);
  CHECK(other.errors.find("[earlier-frames-left]") != std::string::npos);
}

TEST_CASE("A camera that moves away from its light is told of") {
  const Small small;
  const std::string poses =
      small.work.write("poses.tum", "0.0 0 0 0 1 0 0 0\n0.5 0 0 -0.5 1 0 0 0\n1 0 0 -1 1 0 0 0\n");
  const auto check = [&](const std::string &light) {
    return run_pmdsim({"check", small.setup, "--set", "illuminators/0/pose=" + light, "--poses", poses});
  };
  const Run beside = check(R"({"position_m": [0, 0, 0], "look_at_m": [0, 0, -1]})");
  CHECK(beside.errors.find("[light-left-behind]") != std::string::npos);
  CHECK(beside.output.find("3 at the times of the poses, from 0 s to 1 s") != std::string::npos);
  CHECK(check(R"({"position_m": [0, 2, 0], "look_at_m": [0, 0, -2]})").errors.find("left-behind") ==
        std::string::npos); // a lamp of the room
  CHECK(check(R"({"sensor": "pmd"})").errors.find("left-behind") == std::string::npos);
  const Run absent = run_pmdsim({"check", small.setup, "--poses", small.work / "pose.tum"});
  CHECK(absent.exit_code == 3);
  CHECK(absent.errors.find(small.work / "pose.tum" + ": no such file, did you mean \"poses.tum\"?") !=
        std::string::npos);
}

TEST_CASE("Frames along the poses of a file") {
  const Small small;
  const std::string poses =
      small.work.write("poses.tum", "0.0 0 0 0 1 0 0 0\n0.5 0 0 -0.5 1 0 0 0\n2 0 0 -1 1 0 0 0\n");
  const Run run = small.render({small.setup, "--poses", poses, "-o", small.work / "moved"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  const json manifest = json::parse(bytes_in(small.work / "moved/manifest.json"));
  REQUIRE(manifest["frames"].size() == 3);
  CHECK(manifest["frames"][1]["time_s"] == 0.5);
  CHECK(manifest["setup"]["sensors"][0]["pose"]["trajectory"] == "poses.tum"); // from the setup's folder
  // A pose of the second line, written by hand.
  REQUIRE(small
              .render({small.setup, "--set",
                       R"(sensors/0/pose={"position_m": [0, 0, -0.5], "look_at_m": [0, 0, -1.5]})", "-o",
                       small.work / "by_hand"})
              .exit_code == 0);
  CHECK(small.distance("moved", "0001") == small.distance("by_hand"));
  for (const char *shard : {"0/2", "1/2"})
    REQUIRE(small
                .render({small.setup, "--poses", poses, "-o", small.work / ("shard" + std::string(shard, 1)),
                         "--shard", shard})
                .exit_code == 0);
  const Run merged =
      run_pmdsim({"merge", small.work / "shard0", small.work / "shard1", "-o", small.work / "merged"});
  INFO(merged.errors);
  REQUIRE(merged.exit_code == 0);
  CHECK(bytes_in(small.work / "merged/manifest.json") == bytes_in(small.work / "moved/manifest.json"));
  // The wall comes nearer, turned as it is.
  const std::string wall = small.work.write("wall.tum", "0 0 0 0 0 0 0 1\n1 0 0 0.5 0 0 0 1\n");
  REQUIRE(small.render({small.setup, "--poses", "wall=" + wall, "-o", small.work / "wall"}).exit_code == 0);
  CHECK(small.distance("wall", "0001") == small.distance("by_hand"));
  CHECK(run_pmdsim({"check", small.setup, "--poses", "door=" + wall}).errors.find("no node \"door\"") !=
        std::string::npos);
  CHECK(run_pmdsim({"check", small.setup, "--poses", small.setup}).exit_code == 3);
  CHECK(run_pmdsim({"check", small.setup, "--poses", "=x"}).exit_code == 2);
}
