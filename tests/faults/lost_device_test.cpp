// A device that is lost amid a sequence is set up anew, once; the frames have the bits of an undisturbed run.

#include "tests/faults/faulty_runs.h"
#include "tests/faults/plan.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

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

  // Light of another camera, which has a device of its own.
  void add_other_camera() {
    nlohmann::json json = nlohmann::json::parse(std::ifstream(setup));
    json["sensors"][0]["electronics"] = {{"preset", "opt8241_like"},
                                         {"integration_time_s", 2e-4},
                                         {"lens_f_number", 1.2},
                                         {"lens_transmission", 0.8}};
    json["illuminators"].push_back(json["illuminators"][0]);
    json["illuminators"][1]["name"] = "other";
    json["illuminators"][1]["modulation_hz"] = 31e6;
    std::ofstream(setup) << json;
  }

  Run render(const std::string &folder, const std::string &fault,
             const std::vector<std::string> &more = {}) const {
    RunOptions options;
    options.environment["PMDSIM_VALIDATE"] = "0";
    options.environment[faults::plan_variable] = fault;
    options.environment[faults::counts_variable] = work / "counts";
    options.environment["VK_LAYER_PATH"] = PMDSIM_FAILING_LAYER_FOLDER;
    options.environment["VK_INSTANCE_LAYERS"] = "VK_LAYER_PMDSIM_faults";
    if (fault.starts_with("vkWaitForFences")) // of which lavapipe loses those that nobody waits for
      options.environment["LSAN_OPTIONS"] = "detect_leaks=0";
    std::vector<std::string> arguments{"render",   setup, "--device", "cpu",
                                       "--format", "npy", "-o",       work / folder};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_pmdsim(arguments, options);
  }

  // How many there are of the whole run.
  long submits() const {
    REQUIRE(render("undisturbed", "").exit_code == 0);
    std::ifstream counts(work / "counts");
    std::string kind;
    for (long count = 0; counts >> kind >> count;)
      if (kind == "vkQueueSubmit2")
        return count;
    return 0;
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

TEST_CASE("All devices of a process that are lost at once are set up anew") {
  OnDevice sequence;
  sequence.add_other_camera();
  const Run undisturbed = sequence.render("undisturbed", "");
  INFO(undisturbed.errors);
  REQUIRE(undisturbed.exit_code == 0);
  for (const int submit : {1, 2, 3, 4}) {
    const Run run = sequence.render(fmt::format("lost{}", submit), fmt::format("vkQueueSubmit2:{}", submit));
    INFO(submit << ": " << run.errors);
    CHECK(run.exit_code == 0);
    CHECK(run.errors.find("set up anew") != std::string::npos);
    CHECK(sequence.values(fmt::format("lost{}", submit)) == sequence.values("undisturbed"));
  }
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

TEST_CASE("A device that does not come back ends the run with what is done kept") {
  const OnDevice sequence;
  const long last = sequence.submits();
  const Run run = sequence.render("lost", fmt::format("vkQueueSubmit2:{},vkCreateDevice:2", last));
  INFO(run.errors);
  CHECK(run.exit_code == 6);
  CHECK(run.errors.find("pmdsim: error: the device was lost and does not come back: ") != std::string::npos);
  CHECK(run.errors.find(" whole and stay") != std::string::npos);
}

TEST_CASE("A device that does not start is no device, whatever it says") {
  const OnDevice sequence;
  const int code = GENERATE(-3, -4, -13);
  const Run run = sequence.render("none", fmt::format("vkCreateDevice:1:{}", code));
  INFO(run.errors);
  CHECK(run.exit_code == 4);
  CHECK(run.errors.find("the Vulkan device does not start: ") != std::string::npos);
}
