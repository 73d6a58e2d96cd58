// Shards, and folders that are brought together.

#include "tests/program/refusal.h"
#include "tests/whole/command_line/run_fixture.h"

#include <algorithm>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

std::string shard_of(int index, int count) { return fmt::format("{}/{}", index, count); }

// Three folders with the shards of five frames.
struct Shards : ManyFrames {
  Shards() : ManyFrames(5) {
    for (int i = 0; i < 3; ++i)
      run_well(fmt::format("shard{}", i), {"--shard", shard_of(i, 3)});
  }

  std::vector<std::string> merging(const std::vector<std::string> &more = {}) const {
    std::vector<std::string> all{"merge", work / "shard0", work / "shard1", work / "shard2",
                                 "-o",    work / "out"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

} // namespace

TEST_CASE("eight shards of forty frames are one run, from folders of their own or in one", "[long]") {
  const ManyFrames many(40);
  many.run_well("alone");
  std::vector<std::string> merge{"merge"};
  for (int i = 0; i < 8; ++i) {
    many.run_well(fmt::format("shard{}", i), {"--shard", shard_of(i, 8)});
    CHECK(many.frames_in_manifest(fmt::format("shard{}", i)) == 10); // of two sensors
    many.run_well("together", {"--shard", shard_of(i, 8)});
    merge.push_back(many.work / fmt::format("shard{}", i));
  }
  merge.insert(merge.end(), {"-o", many.work / "merged"});
  CHECK(run_pmdsim(merge).exit_code == 0);
  many.check_same("merged", "alone");
  many.check_same("together", "alone");
}

TEST_CASE("shards are merged into what one run gives, again and again") {
  const Shards shards;
  shards.run_well("alone");
  for (int i = 0; i < 2; ++i) {
    const Run run = run_pmdsim(shards.merging({"--json"}));
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
    const json report = json::parse(run.output);
    CHECK(report["frames"] == 5);
    CHECK(report["linked"].get<int>() + report["copied"].get<int>() > 50);
    CHECK(report["outputs"] == json{shards.work / "out/manifest.json"});
    shards.check_same("out", "alone");
  }
  // Once more, as a frame in two of them is taken once.
  const Run twice =
      run_pmdsim({"merge", shards.work / "out", shards.work / "shard1", "-o", shards.work / "both"});
  INFO(twice.errors);
  CHECK(twice.exit_code == 0);
  shards.check_same("both", "alone");
}

TEST_CASE("shards may write into one folder, one after the other") {
  const Shards shards;
  shards.run_well("alone");
  for (int i = 0; i < 3; ++i)
    shards.run_well("together", {"--shard", shard_of(i, 3)});
  shards.check_same("together", "alone");
}

TEST_CASE("some frames alone are merged where they are asked for") {
  const Shards shards;
  CHECK(run_pmdsim(shards.merging({"--frames", "1:3"})).exit_code == 0);
  shards.run_well("alone", {"--frames", "1:3"});
  shards.check_same("out", "alone");
  check_refusal(run_pmdsim(shards.merging({"--frames", "1:6"})), 2, {"--frames 1:6", "at most 5"});
}

TEST_CASE("a merge with frames missing is refused, tells them and writes nothing") {
  const Shards shards;
  std::filesystem::remove(shards.record("shard0", 3));
  std::filesystem::remove(shards.work / "shard1/second_0004.exr");
  std::filesystem::remove(shards.record("shard1", 1));
  check_refusal(run_pmdsim(shards.merging()), 3, {"missing are: 1, 3 to 4\n"});
  CHECK_FALSE(std::filesystem::exists(shards.work / "out"));
}

TEST_CASE("a link is no frame's file, whatever it leads to") {
  const Shards shards;
  const std::string file = shards.work / "shard1/second_0004.exr", elsewhere = shards.work / "elsewhere";
  std::filesystem::rename(file, elsewhere);
  std::filesystem::create_symlink(elsewhere, file);
  check_refusal(run_pmdsim(shards.merging()), 3, {"missing is: 4\n"});
  CHECK(std::filesystem::hard_link_count(elsewhere) == 1);
}

TEST_CASE("what cannot be linked is copied") {
  const std::filesystem::path other_disk = "/dev/shm";
  if (!std::filesystem::is_directory(other_disk)) {
    WARN("there is no /dev/shm");
    return;
  }
  const Shards shards;
  shards.run_well("alone");
  const TemporaryFolder there(other_disk);
  std::vector<std::string> merging{
      "merge", shards.work / "shard0",         shards.work / "shard1", shards.work / "shard2", "--json",
      "-o",    (there.path() / "out").string()};
  const Run run = run_pmdsim(merging);
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  CHECK(json::parse(run.output)["copied"].get<int>() > 50);
  std::filesystem::copy(there.path() / "out", shards.work / "out");
  shards.check_same("out", "alone");
}

TEST_CASE("folders of different runs, and such as hold none, are not merged") {
  const Shards shards;
  std::vector<std::string> arguments = shards.merging();
  SECTION("another setup") {
    shards.work.write("setup.json", with(bytes_in(shards.setup), "50000000.0", "51000000.0"));
    shards.run_well("shard2", {"--shard", "2/3"});
    check_refusal(run_pmdsim(arguments), 3,
                  {"shard2: expected the run of", "the setup differs at /sensors/1/modulation_hz/1"});
  }
  SECTION("another frame") {
    const std::string file = shards.work / "shard0/0000.record.json";
    std::filesystem::copy_file(file, shards.work / "shard1/0000.record.json");
    for (const std::string &name : shards.work.files("shard0"))
      if (name.find("_0000.") != std::string::npos)
        std::filesystem::copy_file(shards.work / ("shard0/" + name), shards.work / ("shard1/" + name));
    CHECK(run_pmdsim(arguments).exit_code == 0);
    std::filesystem::remove_all(shards.work / "out");
    json record = json::parse(bytes_in(file));
    record["sensors"][0]["manifest"]["diodes"] = 3;
    std::ofstream(shards.work / "shard1/0000.record.json") << record;
    check_refusal(run_pmdsim(arguments), 3, {"shard1: frame 0: expected what", "differ"});
  }
  SECTION("none") {
    std::filesystem::create_directory(shards.work / "empty");
    check_refusal(run_pmdsim({"merge", shards.work / "empty"}), 3,
                  {"empty/run.json: no such file, expected what"});
    check_refusal(run_pmdsim({"merge", shards.work / "absent"}), 3,
                  {"absent/run.json: no such file", "expected what"});
    shards.work.write("empty/run.json", "{}");
    check_refusal(run_pmdsim({"merge", shards.work / "empty"}), 3, {"is not a run's file"});
    CHECK_FALSE(std::filesystem::exists(shards.work / "absent"));
  }
  SECTION("a FIFO") {
    std::filesystem::create_directory(shards.work / "empty");
    REQUIRE(::mkfifo((shards.work / "empty/run.json").c_str(), 0600) == 0);
    check_refusal(run_pmdsim({"merge", shards.work / "empty"}), 3, {"empty/run.json: is no regular file"});
  }
  SECTION("no number of frames") {
    const auto frames =
        GENERATE(R"({"count": -1})", R"({"count": 4000000000})", R"({"trajectory": "a"})", "3");
    for (int i = 0; i < 3; ++i) {
      const std::string file = fmt::format("shard{}/run.json", i);
      json run = json::parse(bytes_in(shards.work / file));
      run["setup"]["frames"] = json::parse(frames);
      shards.work.write(file, run.dump());
    }
    check_refusal(run_pmdsim(arguments), 3,
                  {"shard0/run.json: /setup/frames/count: expected the number of the run's frames"});
  }
  SECTION("into one of them") {
    check_refusal(
        run_pmdsim({"merge", shards.work / "shard0", shards.work / "shard1", "-o", shards.work / "shard1/."}),
        2, {"expected none of the directories that are merged"});
  }
  SECTION("into nothing") {
    check_refusal(run_pmdsim({"merge", shards.work / "shard0", shards.work / "shard1"}), 2, {"expected -o"});
  }
  CHECK_FALSE(std::filesystem::exists(shards.work / "out"));
}

TEST_CASE("a folder's manifest is made again as it was") {
  const ManyFrames three(3);
  three.run_well("out");
  const std::string manifest = bytes_in(three.work / "out/manifest.json");
  std::filesystem::remove(three.work / "out/manifest.json");
  CHECK(run_pmdsim({"merge", three.work / "out"}).exit_code == 0);
  CHECK(bytes_in(three.work / "out/manifest.json") == manifest);
}

TEST_CASE("a shard without a frame of its own is done at once") {
  const ManyFrames two(2);
  const std::string command = GENERATE("render", "deform");
  two.run_well("out", {"--shard", "5/8"}, command);
  CHECK(two.work.files("out") == std::vector<std::string>{"manifest.json", "run.json"});
  CHECK(two.frames_in_manifest("out") == 0);
  const Run run = two.run("out", {"--shard", "5/8", "--json"}, command);
  CHECK(json::parse(run.output)["frames"].empty());
}

TEST_CASE("a shard is what Slurm says of an array's task") {
  const ManyFrames five(5);
  std::map<std::string, std::string> task{{"SLURM_ARRAY_TASK_ID", "12"},
                                          {"SLURM_ARRAY_TASK_MIN", "11"},
                                          {"SLURM_ARRAY_TASK_COUNT", "3"},
                                          {"SLURM_ARRAY_TASK_STEP", "1"}};
  const auto arguments = five.arguments("out", {"--shard", "slurm"});
  SECTION("as it is") {
    CHECK(run_pmdsim(arguments, {.environment = task}).exit_code == 0);
    five.run_well("alone", {"--shard", "1/3"});
    five.check_same("out", "alone");
    return;
  }
  std::string expected;
  SECTION("no task") {
    task.erase("SLURM_ARRAY_TASK_ID");
    expected = "SLURM_ARRAY_TASK_ID: expected a whole number";
  }
  SECTION("no count") {
    task["SLURM_ARRAY_TASK_COUNT"] = "";
    expected = "SLURM_ARRAY_TASK_COUNT: expected a whole number";
  }
  SECTION("steps") {
    task["SLURM_ARRAY_TASK_STEP"] = "2";
    expected = "SLURM_ARRAY_TASK_STEP: expected 1";
  }
  SECTION("gaps") {
    task["SLURM_ARRAY_TASK_ID"] = "14";
    expected = "expected an array without gaps";
  }
  check_refusal(run_pmdsim(arguments, {.environment = task}), 2, {expected});
}

TEST_CASE("shards that are none") {
  const ManyFrames two(2);
  const std::string shard = GENERATE("1", "2/2", "-1/2", "1/0", "a/b", "1/2/3", "0/99999999999", "");
  check_refusal(two.run("out", {"--shard", shard}), 2, {"--shard: expected I/N", "\"" + shard + "\""});
}
