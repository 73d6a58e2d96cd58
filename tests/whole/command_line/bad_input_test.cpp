// Bad input on the real binary: the exit code, one clear line that names the file and the place, and nothing
// left in the output directory.

#include "tests/program/program.h"
#include "tests/program/refusal.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sys/stat.h>

using namespace pmdsim::test;

namespace {

// `render` of the setup fails with `exit_code` in one line that holds every one of `fragments`.
void check_refused(const Workspace &work, const std::string &setup, int exit_code,
                   const std::vector<std::string> &fragments) {
  const Run run = run_pmdsim({"render", setup, "-o", work / "out"});
  check_refusal(run, exit_code, fragments);
  CHECK(work.files("out").empty());
}

void check_setup_refused(const std::string &from, const std::string &to,
                         const std::vector<std::string> &fragments) {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  INFO(from << " -> " << to);
  check_refused(work, work.write("setup.json", with(small_setup(), from, to)), 3, fragments);
}

void check_scene_refused(const std::string &gltf, const std::vector<std::string> &fragments) {
  const Workspace work;
  work.write("scene.gltf", gltf);
  check_refused(work, work.write("setup.json", small_setup("scene.gltf")), 3, fragments);
}

void check_diodes_refused(const std::string &csv, const std::vector<std::string> &fragments) {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  work.write("diodes.csv", csv);
  const std::string rings = R"({"rings": [{"radius_m": 0.146, "count": 16}]})";
  check_refused(work, work.write("setup.json", with(small_setup(), rings, R"({"file": "diodes.csv"})")), 3,
                fragments);
}

constexpr const char *diode_header = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n";

} // namespace

TEST_CASE("the setup that the others are made from works") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const Run run = run_pmdsim({"render", work.write("setup.json", small_setup()), "-o", work / "out"});
  INFO(run.errors);
  CHECK(run.exit_code == 0);
  CHECK_FALSE(work.files("out").empty());
}

TEST_CASE("setups that do not exist or are no JSON") {
  const Workspace work;
  check_refused(work, work / "missing.json", 3, {"missing.json", "no such file"});
  check_refused(work, work.path().string(), 3, {"is a directory"});
  check_refused(work, work.write("broken.json", "{\n\"scene\": \"a.gltf\",\n\"sensors\": [}\n}"), 3,
                {"broken.json:3"});
  check_refused(work, work.write("empty.json", ""), 3, {"empty.json"});
  check_refused(work, work.write("deep.json", std::string(20000, '[')), 3, {"deep.json"});
  REQUIRE(::mkfifo((work / "fifo.json").c_str(), 0600) == 0);
  check_refused(work, work / "fifo.json", 3, {"fifo.json", "regular file"});
}

TEST_CASE("unknown, doubled and mistyped keys") {
  check_setup_refused(R"("name": "pmd",)", R"("name": "pmd", "colour": 3,)",
                      {"setup.json", "/sensors/0", "colour"});
  check_setup_refused(R"("name": "pmd",)", R"("name": "pmd", "name": "pmd",)", {"setup.json", "name"});
  check_setup_refused("0.0018", "\"long\"", {"/sensors/0/focal_length_m", "number"});
}

TEST_CASE("values out of range") {
  check_setup_refused("[8, 8]", "[0, 8]", {"/sensors/0/resolution/0"});
  check_setup_refused("[8, 8]", "[8, 100000]", {"/sensors/0/resolution/1", "8192"});
  check_setup_refused("[45e-6, 45e-6]", "[45e-6, -45e-6]", {"/sensors/0/pixel_pitch_m/1"});
  check_setup_refused("0.0018,", "0.0018, \"focus_distance_m\": 0.001,",
                      {"/sensors/0/focus_distance_m", "focal"});
  check_setup_refused("[20e6]", "[0]", {"/sensors/0/modulation_hz"});
  check_setup_refused("[20e6]", "[NaN]", {"setup.json:9:23"});
  check_setup_refused("[20e6]", "[1e999]", {"setup.json:"});
}

TEST_CASE("shadows are auto or off") {
  check_setup_refused("\"sensors\":", R"("shadows": "on", "sensors":)",
                      {"setup.json:4:14: /shadows: ", R"(expected "auto" or "off", found "on")"});
}

TEST_CASE("cameras that cannot be") {
  check_setup_refused("0.0018,", R"(0.0018, "distortion": {"model": "fisheye", "p1": 0},)",
                      {"/sensors/0/distortion", "unknown key \"p1\""});
  check_setup_refused("0.0018,", R"(0.0018, "distortion": {"k1": -1000},)",
                      {"/sensors/0/distortion", "fold over"});
  check_setup_refused("0.0018,", R"(0.0018, "chip": {"translation_m": [0, 0, -0.01]},)",
                      {"/sensors/0/chip", "lens"});
  check_setup_refused("0.0018,", R"(0.0018, "waveform": {"harmonics": [0, 0]},)",
                      {"/sensors/0/waveform/harmonics", "other than 0"});
  check_setup_refused("0.0018,", "0.0018, \"taps\": 17,", {"/sensors/0/taps", "3 to 16"});
}

TEST_CASE("frames and taps at no time") {
  const auto refuse_frames = [](const std::string &frames, const std::vector<std::string> &fragments) {
    check_setup_refused("\"sensors\":", "\"frames\": " + frames + ", \"sensors\":", fragments);
  };
  refuse_frames(R"({"count": 2})", {"setup.json:4:13: /frames: ", "rate_hz"});
  refuse_frames(R"({"count": 0})", {"/frames/count", "1 to 100000"});
  refuse_frames(R"({"count": 100001, "rate_hz": 1})", {"/frames/count", "1 to 100000"});
  refuse_frames(R"({"count": 2, "rate_hz": 0})", {"/frames/rate_hz", "1e-06 to 1000000000"});
  refuse_frames(R"({"start_s": -1.1e9})", {"/frames/start_s", "-1000000000 to 1000000000"});
  check_setup_refused("0.0018,", "0.0018, \"tap_interval_s\": -1,",
                      {"/sensors/0/tap_interval_s", "0 to 1000000"});
}

TEST_CASE("a node that does not exist") {
  check_setup_refused("0.0018,", "0.0018, \"pose\": {\"node\": \"Camera\"},",
                      {"/sensors/0/pose/node", "Camera"});
}

TEST_CASE("diode files") {
  check_diodes_refused("x_m,y_m,z_m,axis_x,axis_y,axis_z,pattern\n0,0,0,0,0,1,isotropic\n",
                       {"diodes.csv", "intensity_w_sr"});
  check_diodes_refused(std::string(diode_header) + "0,0,0,0,0,1,1,isotropic\n0,near,0,0,0,1,1,3\n",
                       {"diodes.csv:3", "y_m", "near"});
  check_diodes_refused(diode_header, {"diodes.csv:2", "at least one diode"});
  check_diodes_refused(std::string(diode_header) + "0,0,0,0,0,0,1,3\n", {"diodes.csv:2", "axis"});
}

TEST_CASE("glTF with indices and ranges that lead out of the file") {
  check_scene_refused(with(wall_gltf(), "\"indices\": 1", "\"indices\": 9"), {"scene.gltf", "9"});
  check_scene_refused(with(wall_gltf(), "\"bufferView\": 1", "\"bufferView\": 7"),
                      {"scene.gltf", "/accessors/1"});
  check_scene_refused(with(wall_gltf(), "\"count\": 4,", "\"count\": 4294967295,"),
                      {"scene.gltf", "/accessors/0"});
  check_scene_refused(with(wall_gltf(), "\"byteOffset\": 48", "\"byteOffset\": 53"), {"scene.gltf"});
  // The last index becomes 9, beyond the four vertices.
  check_scene_refused(with(wall_gltf(), "AAECAAID", "AAECAAIJ"), {"scene.gltf", "/accessors/1", "9"});
}

TEST_CASE("glTF nodes in a cycle, positions that are not numbers, unknown extensions") {
  check_scene_refused(with(wall_gltf(), "\"mesh\": 0}", "\"mesh\": 0, \"children\": [0]}"),
                      {"scene.gltf", "/nodes/0"});
  check_scene_refused(with(wall_gltf(), "zcxMvs3M", "AADAf83M"), {"scene.gltf", "/accessors/0"});
  check_scene_refused(
      with(wall_gltf(), "\"scene\": 0,", "\"scene\": 0, \"extensionsRequired\": [\"EXT_unheard_of\"],"),
      {"scene.gltf", "EXT_unheard_of"});
  check_scene_refused(std::string(20000, '[') + std::string(20000, ']'), {"scene.gltf"});
}

TEST_CASE("buffers outside the scene's folder, or that are no files") {
  const Workspace work;
  const auto refuse_uri = [&](const std::string &uri, const std::vector<std::string> &fragments) {
    const std::string gltf = wall_gltf();
    const auto from = gltf.find("data:"), to = gltf.find('"', from);
    work.write("inside/scene.gltf", std::string(gltf).replace(from, to - from, uri));
    check_refused(work, work.write("inside/setup.json", small_setup("scene.gltf")), 3, fragments);
  };
  std::filesystem::create_directory(work / "inside");
  work.write("outside.bin", std::string(54, '\0'));
  refuse_uri("../outside.bin", {"scene.gltf", "/buffers/0", "outside.bin"});
  refuse_uri("%2e%2e/outside.bin", {"scene.gltf", "/buffers/0"});
  refuse_uri("/etc/passwd", {"scene.gltf", "/buffers/0"});
  std::filesystem::create_symlink("../outside.bin", work / "inside/link.bin");
  refuse_uri("link.bin", {"scene.gltf", "/buffers/0"});
  std::filesystem::create_directory(work / "inside/folder");
  refuse_uri("folder", {"scene.gltf", "/buffers/0", "is a directory"});
  REQUIRE(::mkfifo((work / "inside/fifo").c_str(), 0600) == 0);
  refuse_uri("fifo", {"scene.gltf", "/buffers/0", "regular file"});
}

TEST_CASE("an empty scene is a frame of NaN with a warning") {
  const Workspace work;
  work.write("empty.gltf", R"({"asset": {"version": "2.0"}})");
  for (const char *command : {"render", "deform"}) {
    const Run run =
        run_pmdsim({command, work.write("setup.json", small_setup("empty.gltf")), "-o", work / command});
    INFO(run.errors);
    CHECK(run.exit_code == 0);
    CHECK(run.errors.find("pmdsim: warning: ") == 0);
    CHECK_FALSE(work.files(command).empty());
  }
}

TEST_CASE("an output directory that cannot be written") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  work.write("file", "");
  for (const std::string &directory : {work / "file", std::string("/proc/pmdsim")}) {
    const Run run = run_pmdsim({"render", setup, "-o", directory});
    INFO(run.errors);
    CHECK(run.exit_code == 7);
    CHECK(std::ranges::count(run.errors, '\n') == 1);
    CHECK(run.errors.find(directory) != std::string::npos);
  }
}

TEST_CASE("no Vulkan device") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  const std::map<std::string, std::string> none{{"VK_DRIVER_FILES", "/nonexistent.json"},
                                                {"VK_ICD_FILENAMES", "/nonexistent.json"}};
  const Run run = run_pmdsim({"render", setup, "-o", work / "out"}, {.environment = none});
  INFO(run.errors);
  CHECK(run.exit_code == 4);
  CHECK(std::ranges::count(run.errors, '\n') == 1);
  CHECK(work.files("out").empty());
  const Run by_name = run_pmdsim({"render", setup, "-o", work / "out", "--device", "no such device"});
  CHECK(by_name.exit_code == 4);
  CHECK(by_name.errors.find("no such device") != std::string::npos);
  // The reference needs none.
  CHECK(run_pmdsim({"render", setup, "-o", work / "out", "--device", "reference"}, {.environment = none})
            .exit_code == 0);
}

TEST_CASE("a damaged HDF5 file is told of in one line") {
  const Workspace work;
  // A superblock of version 3, and the begin of the root group's object header.
  const std::vector<unsigned char> begin{0x89, 0x48, 0x44, 0x46, 0x0d, 0x0a, 0x1a, 0x0a, 0x03, 0x08, 0x08,
                                         0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xff, 0xff,
                                         0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x30, 0x08, 0x00, 0x00, 0x00,
                                         0x00, 0x00, 0x00, 0x30, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                                         0xf3, 0x75, 0xe3, 0xe8, 0x4f, 0x48, 0x44, 0x52, 0x02, 0x20};
  std::string bytes(begin.begin(), begin.end());
  bytes.resize(0x083c);
  const Run run = run_pmdsim({"correct", work.write("setup.json", small_setup()),
                              work.write("damaged.h5", bytes), "-o", work / "out"});
  check_refusal(run, 3, {"damaged.h5: cannot be read: HDF5: incorrect metadata checksum"});
}

TEST_CASE("wrong command lines", "[smoke]") {
  for (const std::vector<std::string> &arguments : {std::vector<std::string>{"paint"},
                                                    {"render"},
                                                    {"render", "a.json", "--speed"},
                                                    {"render", "a.json", "--samples", "17"},
                                                    {"render", "a.json", "--format", "gif"},
                                                    {"render", "a.json", "--samples", "all"},
                                                    {"render", "a.json", "--mode", "fast"},
                                                    {"check", "a.json", "--mode", "exact"},
                                                    {"bench", "--samples", "2"},
                                                    {"bench", "--device", "reference"},
                                                    {"bench", "--sweep", "diodes"},
                                                    {"tradeoff"},
                                                    {"tradeoff", "a.json", "--device", "Reference"}}) {
    const Run run = run_pmdsim(arguments);
    INFO(run.errors);
    CHECK(run.exit_code == 2);
    CHECK(std::ranges::count(run.errors, '\n') == 1);
    CHECK(run.output.empty());
  }
}
