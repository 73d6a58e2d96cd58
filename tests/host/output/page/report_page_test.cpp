// The page of a run has what its files have, whatever they hold.

#include "engine/model/error.h"
#include "host/input/frame/frame_file.h"
#include "host/output/files/channel.h"
#include "host/output/files/h5_writer.h"
#include "host/output/page/page_data.h"
#include "host/output/page/page_text.h"
#include "host/output/page/report_page.h"
#include "tests/host/output/page/page_reading.h"
#include "tests/support/temporary_folder.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <random>

using namespace pmdsim;
using nlohmann::json;

namespace {

constexpr glm::uvec2 page_resolution{48, 31};
const std::string hostile = "</script><script>alert(1)</script><!-- \" ' & \u2028 ü \\";

// A directory with frames of random bits and a manifest.
struct PageRun {
  explicit PageRun(std::uint32_t frames = 1, const std::string &ending = ".exr") {
    const std::size_t pixels = std::size_t{page_resolution.x} * page_resolution.y;
    for (std::uint32_t i = 0; i < pixels; ++i) {
      distances.push_back(std::bit_cast<float>(i * 2'654'435'761u));
      ids.push_back(i % 7 == 0 ? 4'294'967'295u : i % 5);
    }
    distances[3] = std::numeric_limits<float>::infinity();
    distances[4] = std::nanf("");
    manifest = {{"program", "pmdsim"}, {"command", "render"}, {"setup", {{"node", hostile}}}};
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
      const std::string name = fmt::format("pmd_{:04}{}", frame, ending);
      manifest["frames"].push_back(
          {{"sensor", "pmd"}, {"frame", frame}, {"outputs", {"pmd.png", name, "pmd.npy"}}});
      OutputFile file(folder.path() / name);
      if (ending == ".exr")
        write_exr(file, channels());
      else
        write_h5(file, channels(), {{}, frame, 0.0});
      file.close();
      file.publish();
    }
    write();
  }

  ChannelSet channels() const {
    return {page_resolution,
            {{"distance_m", "m", std::span(distances)},
             {"tap0", "", std::span(distances)},
             {"object_id", "", std::span(ids)}}};
  }
  void write() const { folder.write("manifest.json", manifest.dump()); }

  std::string page(const ReportRequest &more = {}) const {
    ReportRequest request = more;
    request.directory = folder.path();
    written = write_report(request, [] {});
    return test::text_in(written.file);
  }
  std::string refusal(const ReportRequest &more = {}) const {
    try {
      page(more);
    } catch (const Error &error) {
      CHECK(error.code() == ExitCode::input);
      CHECK_FALSE(std::filesystem::exists(folder.path() / report_name));
      const std::string text = error.what();
      return text.substr(text.find(": ") + 2);
    }
    return "none";
  }

  test::TemporaryFolder folder;
  json manifest;
  std::vector<float> distances;
  std::vector<std::uint32_t> ids;
  mutable WrittenReport written;
};

// Bytes of each channel of the file, by its name.
std::map<std::string, std::string> bytes_in_file(const std::filesystem::path &file) {
  std::map<std::string, std::string> bytes;
  for (const ReadChannel &channel : read_frame(file).channels)
    std::visit(
        [&](const auto &values) {
          bytes[channel.name] = {reinterpret_cast<const char *>(values.data()),
                                 values.size() * sizeof(values[0])};
        },
        channel.values);
  return bytes;
}

std::string block_bytes(const std::string &page, const json &channel) {
  return test::unpacked(test::content_of(page, fmt::format("block-{}", channel.at("block").get<int>())), 4);
}

} // namespace

TEST_CASE("the values of a page are those of the frame's file, bit by bit") {
  const std::string ending = GENERATE(".exr", ".h5");
  const PageRun run(2, ending);
  const std::string page = run.page();
  CHECK(run.written.frames == 2);
  CHECK(run.written.bytes == page.size());
  CHECK(run.written.left_out.empty());
  const auto expected = bytes_in_file(run.folder.path() / ("pmd_0000" + ending));
  REQUIRE(expected.size() == 3);
  const json content = test::run_of(page);
  for (const json &frame : content.at("sensors").at(0).at("frames")) {
    CHECK(frame.at("columns") == page_resolution.x);
    REQUIRE(frame.at("channels").size() == expected.size());
    for (const json &channel : frame.at("channels"))
      CHECK(block_bytes(page, channel) == expected.at(channel.at("name")));
  }
}

TEST_CASE("text of a setup stays text") {
  const PageRun run;
  const std::string page = run.page();
  CHECK(test::run_of(page).at("head").at("setup").at("node") == hostile);
  CHECK(page.find("alert(1)</script>") == std::string::npos);
  CHECK(page.find("<!-- \\") == std::string::npos);
  CHECK(page.find("\u2028") == std::string::npos);
  const std::string text = json_for_script({{"\xff<", "&>"}});
  CHECK(text == "{\"\\ufffd\\u003c\":\"\\u0026\\u003e\"}");
}

TEST_CASE("a page asks for nothing from anywhere") {
  const PageRun run;
  const std::string page = run.page();
  CHECK(page.find("default-src 'none'") != std::string::npos);
  for (const char *asking : {"http:", "https:", "src=", "@import", "url(", "fetch(", "XMLHttpRequest"})
    CHECK(page.find(asking) == std::string::npos);
}

TEST_CASE(
    "where there is too little room less is there, with the values of the files, and the page says so") {
  PageRun run(1);
  run.distances.resize(0);
  constexpr glm::uvec2 large{600, 501};
  std::mt19937 random(3);
  for (std::uint32_t i = 0; i < large.x * large.y; ++i)
    run.distances.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
  OutputFile file(run.folder.path() / "pmd_0000.exr");
  write_exr(file,
            {large, {{"distance_m", "m", std::span(run.distances)}, {"tap0", "", std::span(run.distances)}}});
  file.close();
  file.publish();
  const std::string page = run.page({.max_mib = 1.0});
  CHECK(page.size() < (std::size_t{1} << 20));
  REQUIRE(run.written.left_out.size() == 2);
  const json content = test::run_of(page);
  CHECK(content.at("left_out") == run.written.left_out);
  const auto step = content.at("pixel_step").get<std::uint32_t>();
  CHECK(step == 2);
  const json &frame = content.at("sensors").at(0).at("frames").at(0);
  REQUIRE(frame.at("channels").size() == 1);
  CHECK(frame.at("columns") == 300);
  CHECK(frame.at("rows") == 251);
  const std::string bytes = block_bytes(page, frame.at("channels").at(0));
  std::string expected;
  for (std::size_t row = 0; row < large.y; row += step)
    for (std::size_t column = 0; column < large.x; column += step)
      expected.append(reinterpret_cast<const char *>(&run.distances[row * large.x + column]), sizeof(float));
  CHECK(bytes == expected);
}

TEST_CASE("frames that are far larger than the first are refused, not gathered") {
  PageRun run(2);
  std::mt19937 random(3);
  constexpr glm::uvec2 large{500, 500};
  run.distances.assign(std::size_t{large.x} * large.y, 0.0f);
  for (float &distance : run.distances)
    distance = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
  OutputFile file(run.folder.path() / "pmd_0001.exr");
  write_exr(file, {large, {{"distance_m", "m", std::span(run.distances)}}});
  file.close();
  file.publish();
  for (int i = 0; i < 200; ++i)
    run.manifest["frames"].push_back(run.manifest["frames"][1]);
  run.write();
  constexpr std::size_t wanted_bytes = 100'000, most_bytes = 5'000'000;
  std::size_t frames = 0;
  CHECK_THROWS_WITH(page_data(read_run(run.folder.path(), std::nullopt), {wanted_bytes, most_bytes},
                              [&frames] { ++frames; }),
                    Catch::Contains("no room for frames that are so much larger than its first"));
  CHECK(frames < 100);
}

TEST_CASE("some frames alone, and a page elsewhere") {
  const PageRun run(5);
  const std::filesystem::path elsewhere = run.folder.path() / "elsewhere.html";
  const json content = test::run_of(run.page({.file = elsewhere, .frames = FrameRange{2, 4}}));
  CHECK(run.written.file == elsewhere);
  const json &frames = content.at("sensors").at(0).at("frames");
  REQUIRE(frames.size() == 2);
  CHECK(frames.at(0).at("frame") == 2);
  CHECK(frames.at(1).at("frame") == 3);
}

TEST_CASE("what is no run's directory is refused") {
  PageRun run;
  CHECK(run.refusal({.frames = FrameRange{7, 9}}) == "has no frame from 7 to 8");
  run.manifest["frames"][0]["outputs"] = {"pmd.png", "pmd.npy", "../pmd_0000.exr", ".pmd.exr"};
  run.write();
  CHECK(run.refusal() ==
        "\"pmd\", frame 0: expected a file of all its channels (.exr, .h5) among the outputs, as "
        "--format exr writes it");
  run.manifest["frames"] = json::array();
  run.write();
  CHECK(run.refusal() == "has no frames");
  for (const char *text :
       {"", "[]", "{}", "{\"frames\": 3}", "{\"frames\": [{}]}", "{\"frames\": [{\"sensor\": 1}]}",
        "{\"frames\": [{\"sensor\": \"a\", \"frame\": -1, \"outputs\": {}}]}",
        "{\"frames\": [{\"sensor\": \"pmd\", \"frame\": 3.5e38, \"outputs\": [\"pmd_0000.exr\"]}]}",
        "{\"frames\": [{\"sensor\": \"pmd\", \"frame\": 4294967296, \"outputs\": [\"pmd_0000.exr\"]}]}"}) {
    run.folder.write("manifest.json", text);
    INFO(text);
    CHECK(run.refusal() ==
          "is no manifest, expected what render, deform or correct leaves beside its frames");
  }
  std::filesystem::remove(run.folder.path() / "manifest.json");
  CHECK(run.refusal().find("expected what render, deform or correct leaves") != std::string::npos);
}

TEST_CASE("a frame's file that cannot be read is named") {
  const PageRun run;
  run.folder.write("pmd_0000.exr", "no frame");
  CHECK(run.refusal() == "expected a frame as an EXR or an HDF5 file");
}
