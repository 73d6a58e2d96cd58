// Pictures of whole runs: they come when all frames that they show are there, whoever made these.

#include "tests/whole/command_line/run_fixture.h"

#include <algorithm>

using namespace pmdsim::test;

namespace {

struct PictureFrames : ManyFrames {
  using ManyFrames::ManyFrames;

  void render(const std::string &folder, std::vector<std::string> more = {},
              const std::string &command = "render") const {
    std::vector<std::string> all{command,    setup, "--device", "reference",
                                 "--format", "png", "-o",       work / folder};
    all.insert(all.end(), more.begin(), more.end());
    const Run run = run_pmdsim(all);
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
  }
  std::vector<std::string> sheets(const std::string &folder) const {
    std::vector<std::string> found = work.files(folder);
    std::erase_if(found, [](const std::string &name) {
      return !name.ends_with(".sheet.png") && !name.ends_with(".apng");
    });
    return found;
  }
};

const std::vector<std::string> all_sheets{"pmd.amplitude.apng",        "pmd.amplitude.sheet.png",
                                          "pmd.distance_m.apng",       "pmd.distance_m.sheet.png",
                                          "second.f0.amplitude.apng",  "second.f0.amplitude.sheet.png",
                                          "second.f0.distance_m.apng", "second.f0.distance_m.sheet.png"};

} // namespace

TEST_CASE("several frames have a contact sheet and an animation of each sensor, one frame has none") {
  const PictureFrames frames(3);
  frames.render("out");
  CHECK(frames.sheets("out") == all_sheets);
  frames.render("deformed", {}, "deform");
  CHECK(frames.sheets("deformed") ==
        std::vector<std::string>{"pmd.deformation_mm.apng", "pmd.deformation_mm.sheet.png",
                                 "second.f0.deformation_mm.apng", "second.f0.deformation_mm.sheet.png"});
  const PictureFrames one(1);
  one.render("out");
  CHECK(one.sheets("out").empty());
  frames.run_well("values"); // no pictures are asked for
  CHECK(frames.sheets("values").empty());
}

TEST_CASE("pictures of a run come with its last frame, the same however the frames were made") {
  const PictureFrames frames(4);
  frames.render("whole");
  frames.render("resumed", {"--frames", "1:3"});
  CHECK(frames.sheets("resumed").empty());
  frames.render("resumed", {"--resume"});
  frames.check_same("resumed", "whole");
  frames.render("shards", {"--shard", "0/2"});
  CHECK(frames.sheets("shards").empty());
  frames.render("shards", {"--shard", "1/2"});
  frames.check_same("shards", "whole");
}

TEST_CASE("merging makes the pictures that no part could") {
  const PictureFrames frames(4);
  frames.render("whole");
  frames.render("even", {"--shard", "0/2"});
  frames.render("odd", {"--shard", "1/2"});
  const Run merged = run_pmdsim(
      {"merge", frames.work / "even", frames.work / "odd", "-o", frames.work / "merged", "--json"});
  INFO(merged.errors);
  REQUIRE(merged.exit_code == 0);
  frames.check_same("merged", "whole");
  const auto outputs = nlohmann::json::parse(merged.output).at("outputs");
  CHECK(outputs.size() == all_sheets.size() + 1);
}

TEST_CASE("pictures of another run go when a new one begins") {
  const PictureFrames frames(3);
  frames.render("out");
  frames.render("out", {"--samples", "2", "--frames", "0:1"});
  CHECK(frames.sheets("out").empty());
}

TEST_CASE("an edited record costs the pictures alone") {
  const PictureFrames frames(2);
  frames.render("out", {"--frames", "0:1"});
  const std::string record = frames.record("out", 0);
  auto edited = nlohmann::ordered_json::parse(bytes_in(record));
  edited["sensors"][0]["thumbnails"][0]["resolution"] = {128, 128};
  frames.work.write("out/0000.record.json", edited.dump());
  frames.render("out", {"--resume"});
  CHECK(frames.sheets("out").empty());
  CHECK(frames.frames_in_manifest("out") == 4);
}

TEST_CASE("a record's channel that can name no file has no pictures") {
  const PictureFrames frames(2);
  frames.render("out", {});
  for (const int frame : {0, 1}) {
    auto edited = nlohmann::ordered_json::parse(bytes_in(frames.record("out", frame)));
    for (auto &sensor : edited["sensors"])
      sensor["thumbnails"][0]["channel"] = "a/../../evil";
    frames.work.write(fmt::format("out/{:04}.record.json", frame), edited.dump());
  }
  const Run merged = run_pmdsim({"merge", frames.work / "out"});
  INFO(merged.errors);
  CHECK(merged.exit_code == 0);
  CHECK(merged.output.find("evil") == std::string::npos);
}

TEST_CASE("render and deform tell of the pictures") {
  const PictureFrames frames(2);
  const Run text = run_pmdsim(
      {"render", frames.setup, "--device", "reference", "--format", "png", "-o", frames.work / "text"});
  CHECK(text.output.find("pmd.distance_m.sheet.png\n") != std::string::npos);
  for (const char *command : {"render", "deform"}) {
    const Run run = run_pmdsim({command, frames.setup, "--device", "reference", "--format", "png", "-o",
                                frames.work / command, "--json"});
    const auto report = nlohmann::json::parse(run.output);
    const auto told = report.at(std::string(command) == "render" ? "sheets" : "outputs");
    CHECK(std::ranges::any_of(told, [](const std::string &path) { return path.ends_with(".apng"); }));
  }
}
