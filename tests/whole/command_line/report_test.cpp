// pmdsim report, and --report of the commands that write frames.

#include "tests/program/refusal.h"
#include "tests/whole/command_line/run_fixture.h"

using namespace pmdsim::test;
using nlohmann::json;

namespace {

struct SmallRun {
  SmallRun() {
    work.write("wall.gltf", wall_gltf());
    setup = work.write("setup.json", small_setup());
  }

  std::vector<std::string> measuring(const std::string &command, const std::vector<std::string> &more) const {
    std::vector<std::string> all{command, setup, "--device", "reference", "-o", work / "out"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Run measure(const std::string &command, const std::vector<std::string> &more) const {
    const Run run = run_pmdsim(measuring(command, more));
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
    return run;
  }
  std::string page() const { return bytes_in(work / "out/report.html"); }
  json content(const std::string &text) const {
    const std::string mark = "id=\"run\">";
    const std::size_t begin = text.find(mark) + mark.size();
    return json::parse(text.substr(begin, text.find("</script>", begin) - begin));
  }

  Workspace work;
  std::string setup;
};

} // namespace

TEST_CASE("a run makes its own report, the same that is made of it later", "[smoke]") {
  const SmallRun small;
  const std::string command = GENERATE("render", "deform");
  const std::string format = GENERATE("exr", "h5,npy");
  const Run run = small.measure(command, {"--report", "--format", format});
  CHECK(run.output.ends_with("\nreport:\n  " + (small.work / "out/report.html") + "\n"));
  const std::string page = small.page();
  REQUIRE_FALSE(page.empty());
  CHECK(small.content(page).at("head").at("command") == command);
  CHECK(small.content(page).at("sensors").at(0).at("frames").at(0).contains("passes_ms"));
  std::filesystem::remove(small.work / "out/report.html");
  const Run later = run_pmdsim({"report", small.work / "out"});
  INFO(later.errors);
  REQUIRE(later.exit_code == 0);
  CHECK(later.output.starts_with("1 frame, 0."));
  CHECK(small.page() == page);
}

TEST_CASE("scripts are told where the report is") {
  const SmallRun small;
  const std::string path = small.work / "out/report.html";
  for (const char *command : {"render", "deform"})
    CHECK(json::parse(small.measure(command, {"--report", "--json"}).output).at("report") == path);
  CHECK_FALSE(json::parse(small.measure("render", {"--json"}).output).contains("report"));
  const Run report = run_pmdsim({"report", small.work / "out", "-o", small.work / "x.html", "--json"});
  REQUIRE(report.exit_code == 0);
  const json told = json::parse(report.output);
  CHECK(told.at("report") == small.work / "x.html");
  CHECK(told.at("bytes") == bytes_in(small.work / "x.html").size());
  CHECK(told.at("frames") == 1);
  CHECK(told.at("left_out") == json::array());
}

TEST_CASE("several sensors and frames are in one page, and each variant has its own") {
  const ManyFrames many(3);
  many.run_well("out", {"--report"});
  const std::string page = bytes_in(many.work / "out/report.html");
  const std::size_t begin = page.find("id=\"run\">") + 9;
  const json content = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  REQUIRE(content.at("sensors").size() == 2);
  for (const json &sensor : content.at("sensors"))
    CHECK(sensor.at("frames").size() == 3);
  many.work.write("variants.jsonl", "{\"sensors/0/samples\": 1}\n{\"sensors/0/samples\": 2}\n");
  many.run_well("variants", {"--report", "--frames", "0:1", "--variants", many.work / "variants.jsonl"});
  std::size_t pages = 0;
  for (const std::string &file : many.work.files("variants"))
    pages += file.ends_with("report.html") ? 1u : 0u;
  CHECK(pages == 2);
}

TEST_CASE("a shard without frames has nothing to report") {
  const SmallRun small;
  const Run run = small.measure("render", {"--report", "--shard", "1/2"});
  CHECK(run.output.find("report") == std::string::npos);
}

TEST_CASE("what a report cannot be made of is refused before anything is measured") {
  const SmallRun small;
  check_refusal(run_pmdsim(small.measuring("render", {"--report", "--format", "npy,png"})), 2,
                {"--report: it is made of the frames' files, expected exr or h5 in --format"});
  check_refusal(run_pmdsim({"report", small.work / "none"}), 3,
                {"none/manifest.json: no such file", "expected what render, deform or correct leaves"});
  small.measure("render", {"--format", "png,csv"});
  check_refusal(run_pmdsim({"report", small.work / "out"}), 3,
                {small.work / "out/manifest.json",
                 ": \"pmd\", frame 0: expected a file of all its channels (.exr, .h5)"});
  for (const std::string size : {"0.5", "1001", "nan", "ten", "10 MiB"})
    check_refusal(run_pmdsim({"report", small.work / "out", "--max-size", size}), 2,
                  {"--max-size: expected a number of MiB from 1 to 1000, found \"" + size + "\""});
  check_refusal(run_pmdsim({"report"}), 2, {"DIR"});
}

TEST_CASE("a page that cannot be written leaves nothing") {
  const SmallRun small;
  small.measure("render", {"--format", "exr"});
  const Run run = run_pmdsim({"report", small.work / "out", "-o", small.work / "nowhere/x.html"});
  CHECK(run.exit_code == 7);
  CHECK(run.errors.find("nowhere/x.html") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(small.work / "nowhere"));
}
