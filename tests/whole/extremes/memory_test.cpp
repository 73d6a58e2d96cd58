// Memory is asked for before it is taken: forecasts against the peaks that were measured, and limits that are
// kept.

#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>

using namespace pmdsim::test;

namespace {

const RunOptions as_users{.environment = {{"PMDSIM_VALIDATE", "0"}}}; // the layer takes memory of its own

Run run_well(std::vector<std::string> arguments, const std::vector<std::string> &more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  Run run = run_pmdsim(arguments, as_users);
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  return run;
}

// Prints what `check` foresees beside what `render` takes.
void compare_memory(const std::string &name, const std::string &setup,
                    const std::vector<std::string> &changes = {}) {
  constexpr double lowest = 0.9, highest = 2.0;
  const Workspace work;
  std::vector<std::string> set;
  for (const std::string &change : changes) {
    set.emplace_back("--set");
    set.push_back(change);
  }
  const Run check = run_well({"check", setup, "--json"}, set);
  const double forecast = nlohmann::json::parse(check.output).at("memory").at("bytes").get<double>();
  const Run render = run_well({"render", setup, "-o", work / "out"}, set);
  const double peak = static_cast<double>(render.peak_resident_bytes);
  fmt::print("{:<46} forecast {:>6.0f} MB, peak {:>6.0f} MB, {:.2f} times\n", name, 1e-6 * forecast,
             1e-6 * peak, forecast / peak);
  INFO(name);
  CHECK(forecast >= lowest * peak);
  CHECK(forecast <= highest * peak);
}

// Sensors of the setup at so many pixels a side and the same view.
std::vector<std::string> sized(int pixels, const std::vector<std::string> &more = {}) {
  std::vector<std::string> changes{fmt::format("sensors/0/resolution=[{0},{0}]", pixels),
                                   fmt::format("sensors/0/pixel_pitch_m=[{0},{0}]", 640 * 45e-6 / pixels)};
  changes.insert(changes.end(), more.begin(), more.end());
  return changes;
}

} // namespace

TEST_CASE("forecasts of memory are right within a factor of two, and not much too low", "[no_sanitizer]") {
  const std::string room = scene("room.json");
  compare_memory("the room", room);
  compare_memory("the room, 512 x 512, 4 frequencies", room,
                 sized(512, {"sensors/0/modulation_hz=[20e6,30e6,50e6,70e6]"}));
  compare_memory("a corner with bounces", scene("corner.json"));
}

TEST_CASE("forecasts of memory hold whatever is measured", "[long]") {
  const std::string room = scene("room.json");
  compare_memory("the room, 2048 x 2048", room, sized(2048));
  compare_memory("the room, 512 x 512, 4 x 4 samples", room, sized(512, {"sensors/0/samples=4"}));
  compare_memory("the room, 512 x 512, square light, 8 taps", room,
                 sized(512, {"sensors/0/waveform=square", "sensors/0/taps=8"}));
  compare_memory("the room, 1024 x 1024, no shadows", room, sized(1024, {"shadows=off"}));
  compare_memory("the showroom", scene("showroom/showroom.json"));
  compare_memory("what moves", scene("motion.json"));
}

TEST_CASE("forecasts of memory hold for procedural scenes", "[long]") {
  const Workspace work;
  for (const char *triangles : {"100000", "300000"}) {
    const std::string folder = work / (std::string("scenes_") + triangles);
    run_well({"bench", "--suite", "real", "--kinds", "room,terrain,forest,knot", "--triangles", triangles,
              "--write-scenes", folder},
             {});
    for (const auto &entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".json")
        compare_memory(fmt::format("{}, {} triangles", entry.path().stem().string(), triangles),
                       entry.path());
  }
}

TEST_CASE("what does not fit is refused before it is begun, and what fits stays within") {
  const Workspace work;
  const std::string room = scene("room.json");
  std::vector<std::string> large{"render", room, "-o", work / "out"};
  for (const std::string &change : sized(8192)) {
    large.emplace_back("--set");
    large.push_back(change);
  }
  large.insert(large.end(), {"--max-memory", "500 MB"});
  const Run refused = run_pmdsim(large, as_users);
  CHECK(refused.exit_code == 5);
  CHECK(refused.errors.find("pmdsim: error: out of memory: a frame of the sensor ") == 0);
  CHECK(refused.errors.find(", --max-memory is 500 MB, most of it for ") != std::string::npos);
  CHECK(refused.errors.find('\n') == refused.errors.size() - 1);
  CHECK(refused.peak_resident_bytes < 500'000'000);
  CHECK_FALSE(std::filesystem::exists(work / "out"));

  std::vector<std::string> small{"render", room, "-o", work / "out", "--max-memory", "1.5GB"};
  const Run done = run_pmdsim(small, as_users);
  INFO(done.errors);
  CHECK(done.exit_code == 0);
  CHECK(done.peak_resident_bytes < 1'500'000'000);
}

TEST_CASE("strips become shorter before a frame is refused", "[no_sanitizer]") {
  const Workspace work;
  std::vector<std::string> set;
  for (const std::string &change : sized(1800))
    set.insert(set.end(), {"--set", change});
  const Run check = run_well({"check", scene("room.json"), "--json"}, set);
  const double with_usual_strips = nlohmann::json::parse(check.output).at("memory").at("bytes").get<double>();

  std::vector<std::string> render{"render", scene("room.json"), "-o", work / "out"};
  render.insert(render.end(), set.begin(), set.end());
  const auto within = [&](const std::string &limit) {
    std::vector<std::string> arguments = render;
    arguments.insert(arguments.end(), {"--max-memory", limit});
    return run_pmdsim(arguments, as_users);
  };
  const Run refused = within("100 MB");
  std::smatch megabytes;
  REQUIRE(std::regex_search(refused.errors, megabytes,
                            std::regex(R"(needs ([0-9.]+) MB beside the ([0-9.]+) MB)")));
  const int limit_mb = 10 + static_cast<int>(std::stod(megabytes[1]) + std::stod(megabytes[2]));
  CHECK(1e6 * limit_mb < with_usual_strips);
  const Run done = within(fmt::format("{} MB", limit_mb));
  INFO(done.errors);
  CHECK(done.exit_code == 0);
  CHECK(done.peak_resident_bytes < std::int64_t{1'000'000} * limit_mb);
}

TEST_CASE("scenes and tables are within the limit, too") {
  const Workspace work;
  const std::string room = scene("room.json");
  for (const std::vector<std::string> &command :
       {std::vector<std::string>{"check", room}, {"diodes", room, "-o", work / "diodes"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--max-memory", "20MB"});
    const Run refused = run_pmdsim(arguments, as_users);
    CHECK(refused.exit_code == 5);
    CHECK(refused.errors.find("out of memory: ") != std::string::npos);
    CHECK(refused.errors.find("--max-memory is 20 MB") != std::string::npos);
  }
  const std::string run = work / "run";
  run_well({"render", scene("corner.json"), "-o", run, "--format", "exr"}, {});
  for (const char *command : {"report", "merge"}) {
    const Run refused = run_pmdsim({command, run, "--max-memory", "1MB"}, as_users);
    INFO(command << ": " << refused.errors);
    CHECK(refused.exit_code == 5);
    CHECK(refused.errors.find("--max-memory is 1 MB") != std::string::npos);
  }
  const Run misread = run_pmdsim({"check", room, "--max-memory", "4"}, as_users);
  CHECK(misread.exit_code == 2);
  CHECK(misread.errors.find("--max-memory: expected a number of bytes with its unit") != std::string::npos);
}
