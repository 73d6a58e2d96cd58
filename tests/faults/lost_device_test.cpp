// A device that is lost amid a sequence is set up anew, once; the frames have the bits of an undisturbed run.

#include "tests/faults/faulty_runs.h"
#include "tests/faults/plan.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim::test;
using namespace pmdsim;

namespace {

struct OnDevice {
  Workspace work;
  std::string setup;

  OnDevice() {
    work.write("wall.gltf", wall_gltf());
    setup = work.write("setup.json", with(small_setup(), "\"sensors\":",
                                          R"("frames": {"rate_hz": 10, "count": 4}, "sensors":)"));
  }

  Run render(const std::string &folder, const std::string &fault,
             const std::vector<std::string> &more = {}) const {
    RunOptions options;
    options.environment["PMDSIM_VALIDATE"] = "0";
    options.environment[faults::plan_variable] = fault;
    options.environment[faults::counts_variable] = work / "counts";
    options.environment["VK_LAYER_PATH"] = PMDSIM_FAILING_LAYER_FOLDER;
    options.environment["VK_INSTANCE_LAYERS"] = "VK_LAYER_PMDSIM_faults";
    std::vector<std::string> arguments{"render",   setup, "--device", "cpu",
                                       "--format", "npy", "-o",       work / folder};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_pmdsim(arguments, options);
  }

  // The values of frames, without records and manifest, which have times.
  Files values(const std::string &folder) const {
    Files files = files_below(work / folder);
    std::erase_if(files, [](const auto &file) { return file.first.ends_with(".json"); });
    return files;
  }
};

} // namespace

TEST_CASE("A device that is lost once is set up anew, and the frames are the same") {
  const OnDevice sequence;
  REQUIRE(sequence.render("undisturbed", "").exit_code == 0);
  const std::string fault =
      GENERATE("vkQueueSubmit2:3", "vkWaitForFences:7", "vkQueueSubmit2:1", "vkQueueSubmit2:6:-13");
  INFO(fault);
  const Run run = sequence.render("lost", fault);
  INFO(run.errors);
  CHECK(run.exit_code == 0);
  CHECK(run.errors.find("note: the device ") != std::string::npos);
  CHECK(run.errors.find("set up anew") != std::string::npos);
  CHECK(sequence.values("lost") == sequence.values("undisturbed"));
}

TEST_CASE("A device that is lost again ends the run with what is done kept") {
  const OnDevice sequence;
  REQUIRE(sequence.render("undisturbed", "").exit_code == 0);
  const Run run = sequence.render("lost", "vkQueueSubmit2:5+");
  INFO(run.errors);
  CHECK(run.exit_code == 6);
  CHECK(run.errors.find("pmdsim: error: the device was lost") != std::string::npos);
  const Files all = sequence.values("undisturbed");
  for (const auto &[name, bytes] : sequence.values("lost"))
    CHECK(all.at(name) == bytes);
  const Run resumed = sequence.render("lost", "", {"--resume"});
  INFO(resumed.errors);
  CHECK(resumed.exit_code == 0);
  CHECK(sequence.values("lost") == all);
}

TEST_CASE("A device that does not come back ends the run") {
  const OnDevice sequence;
  const Run run = sequence.render("lost", "vkCreateDevice:1:-3");
  INFO(run.errors);
  CHECK(run.exit_code == 4);
}
