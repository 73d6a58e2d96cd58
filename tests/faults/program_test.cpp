// Each call of the system and of the device that the program makes fails in turn.

#include "tests/faults/faulty_runs.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim::test;

namespace {

// What a workload's files need, for as long as its runs last.
struct Folder {
  Workspace work;
  std::string setup;

  Folder() {
    work.write("wall.gltf", wall_gltf());
    setup = work.write("setup.json", with(small_setup(), "\"sensors\":",
                                          R"("frames": {"rate_hz": 10, "count": 3}, "sensors":)"));
  }
};

Workload render(const Folder &folder, const std::string &device) {
  return {
      device == "reference" ? "reference" : "render",
      {"render", folder.setup, "--device", device, "--format", "exr,npz,npy,png,csv,h5,ply", "-o", "OUT"}};
}

void check_survived(const Workload &workload, const std::map<std::string, std::size_t> &most_of_kind,
                    std::size_t most_else) {
  const FaultyRuns runs(workload);
  for (const Outcome &outcome : survive_all(runs, workload.name, most_of_kind, most_else)) {
    UNSCOPED_INFO(outcome.fault << ": " << outcome.wrong);
    CHECK(outcome.wrong.empty());
  }
}

} // namespace

TEST_CASE("Calls that fail while frames are rendered end the run well", "[no_sanitizer]") {
  const Folder folder;
  // Of the tens of thousands of allocations few, whose order changes with the threads.
  check_survived(render(folder, "cpu"), {{"malloc", 12}}, 1);
}

TEST_CASE("Where no thread can be started, one does all", "[no_sanitizer]") {
  const Folder folder;
  for (const char *device : {"cpu", "reference"}) {
    INFO(device);
    const Outcome outcome = FaultyRuns(render(folder, device)).survive("pthread_create:1+");
    INFO(outcome.wrong);
    CHECK(outcome.has_failed);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.wrong.empty());
  }
}

TEST_CASE("Calls that fail, many of them", "[long]") {
  const Folder folder;
  SECTION("render") { check_survived(render(folder, "cpu"), {{"malloc", 200}}, 12); }
  SECTION("reference") { check_survived(render(folder, "reference"), {{"malloc", 60}}, 4); }
  SECTION("check") { check_survived({"check", {"check", folder.setup}, false, {}}, {{"malloc", 60}}, 4); }
  SECTION("deform") {
    check_survived({"deform", {"deform", folder.setup, "--device", "cpu", "-o", "OUT"}}, {{"malloc", 40}}, 4);
  }
  SECTION("new") { check_survived({"new", {"new", "room", "OUT"}, false, {"--force"}}, {{"malloc", 30}}, 4); }
}
