// The C interface measures what the program writes, and what a setup that was changed says.

#include "tests/library/fixture.h"

#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

// The values of an .npy file, without its header of 128 bytes or a multiple of 64.
std::string npy_values(const std::string &file, std::size_t bytes) {
  std::ifstream stream(file, std::ios::binary);
  std::string whole{std::istreambuf_iterator<char>(stream), {}};
  REQUIRE(whole.size() > bytes);
  return whole.substr(whole.size() - bytes);
}

json described(pmdsim_simulator *simulator) {
  const char *text = nullptr;
  REQUIRE(pmdsim_simulator_describe(simulator, &text) == PMDSIM_OK);
  return json::parse(text);
}

// A square of 2 x 2 m at z = -2 m, which faces a camera at the origin.
struct Square {
  std::vector<double> positions_m{-1, -1, -2, 1, -1, -2, 1, 1, -2, -1, 1, -2};
  std::vector<std::uint32_t> triangles{0, 1, 2, 0, 2, 3};
  pmdsim_mesh mesh{sizeof(pmdsim_mesh), positions_m.data(), 4, triangles.data(), 2, nullptr, nullptr, 0};
};

std::string setup_without_scene() {
  json setup = json::parse(small_setup());
  setup.erase("scene");
  return setup.dump();
}

} // namespace

TEST_CASE("A frame has the bytes that the program writes", "[smoke]") {
  const Loaded loaded;
  pmdsim_frame *frame = loaded.render();
  REQUIRE(run_pmdsim({"render", loaded.file, "-o", loaded.work / "out", "--format", "npy"}).exit_code == 0);
  std::size_t count = 0;
  REQUIRE(pmdsim_frame_channel_count(frame, &count) == PMDSIM_OK);
  CHECK(count >= 12);
  for (std::size_t i = 0; i < count; ++i) {
    pmdsim_channel channel{};
    channel.struct_size = sizeof(channel);
    REQUIRE(pmdsim_frame_channel(frame, i, &channel) == PMDSIM_OK);
    INFO(channel.name);
    const std::size_t bytes = 4 * std::size_t{channel.rows} * channel.columns;
    const std::string written = npy_values(loaded.work / "out/pmd_0000." + channel.name + ".npy", bytes);
    CHECK(std::memcmp(written.data(), channel.values, bytes) == 0);
  }
  CHECK(pmdsim_frame_destroy(frame) == PMDSIM_OK);
}

TEST_CASE("A setup that is changed is measured, and one that is refused stays") {
  const Loaded loaded;
  pmdsim_frame *before = loaded.render();
  REQUIRE(pmdsim_simulator_set(
              loaded.simulator,
              R"({"sensors/pmd/pose": {"position_m": [0, 0, -1], "look_at_m": [0, 0, -2]}})") == PMDSIM_OK);
  pmdsim_frame *nearer = loaded.render();
  CHECK(middle(before, "z_m") == 2.0f);
  CHECK(middle(nearer, "z_m") == 1.0f);
  CHECK(pmdsim_simulator_set(loaded.simulator, R"({"sensors/0/taps": 5, "/sensors/0/focal_length_m": -1})") ==
        PMDSIM_BAD_INPUT);
  CHECK(std::string(pmdsim_error_place()) == "/sensors/0/focal_length_m");
  CHECK(std::string(pmdsim_error_file()) == loaded.file);
  CHECK(described(loaded.simulator)["setup"]["sensors"][0]["taps"] == 4);
  pmdsim_frame *again = loaded.render();
  CHECK(floats_of(again, "phase_rad") == floats_of(nearer, "phase_rad"));
  for (pmdsim_frame *frame : {before, nearer, again})
    CHECK(pmdsim_frame_destroy(frame) == PMDSIM_OK);
}

TEST_CASE("Files of a setup stay where they were when the process goes to another directory") {
  const Loaded loaded(
      with(small_setup(), "\"diodes\"", "\"pattern\": {\"file\": \"pattern.csv\"}, \"diodes\""), nullptr,
      {{"pattern.csv", "angle_deg,relative\n0,1\n90,1\n"}});
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(loaded.work / ".");
  REQUIRE(pmdsim_simulator_load(loaded.simulator, "setup.json") == PMDSIM_OK);
  std::filesystem::current_path(before);
  const pmdsim_status status = pmdsim_simulator_set(loaded.simulator, R"({"sensors/0/taps": 5})");
  INFO(told());
  CHECK(status == PMDSIM_OK);
}

TEST_CASE("Frames whose taps are taken one after the other say that no error is claimed of them") {
  json setup = json::parse(small_setup());
  setup["sensors"][0]["tap_interval_s"] = 0.001;
  setup["sensors"][0]["pose"] = {{"trajectory", "poses.csv"}};
  const std::string poses = "time_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,0,0,0,0,1,0,0\n1,0,0,0.1,0,1,0,0\n";
  const Loaded loaded(setup.dump(), nullptr, {{"poses.csv", poses}});
  pmdsim_render_options options{};
  options.struct_size = sizeof(options);
  options.max_error_m = 1e-5;
  pmdsim_frame *frame = loaded.render(&options);
  const char *report = nullptr;
  REQUIRE(pmdsim_frame_report(frame, &report) == PMDSIM_OK);
  CHECK(json::parse(report)["warnings"][0]["code"] == "tap-by-tap-exact");
  CHECK(pmdsim_frame_destroy(frame) == PMDSIM_OK);
  options.strict = 1;
  CHECK(pmdsim_render(loaded.simulator, 0, 0, &options, &frame) == PMDSIM_BAD_ACCURACY);
}

TEST_CASE("A node of the scene is put elsewhere") {
  Loaded loaded;
  json scene = json::parse(wall_gltf());
  scene["nodes"][0]["name"] = "wall";
  scene["nodes"][0]["scale"] = {2, 2, 2};
  scene["nodes"][0]["translation"] = {0, 0, 2};
  loaded.work.write("wall.gltf", scene.dump());
  REQUIRE(pmdsim_simulator_load(loaded.simulator, loaded.file.c_str()) == PMDSIM_OK);
  pmdsim_frame *there = loaded.render(); // 2 * 2 - 2 = 2 m away
  const char *half_a_metre_nearer =
      R"({"nodes/wall/pose": {"matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,2.5],[0,0,0,1]]}})";
  INFO(told());
  REQUIRE(pmdsim_simulator_set(loaded.simulator, half_a_metre_nearer) == PMDSIM_OK);
  pmdsim_frame *moved = loaded.render();
  CHECK(middle(there, "z_m") == Approx(2.0f));
  CHECK(middle(moved, "z_m") == Approx(1.5f));
  CHECK(
      pmdsim_simulator_set(loaded.simulator,
                           R"({"nodes/door/pose": {"matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}})") ==
      PMDSIM_BAD_INPUT);
  CHECK(told().find("no node \"door\"") != std::string::npos);
  for (pmdsim_frame *frame : {there, moved})
    pmdsim_frame_destroy(frame);
}

TEST_CASE("A mesh is a scene") {
  const Loaded loaded;
  Square square;
  const std::string text = setup_without_scene();
  REQUIRE(pmdsim_simulator_load_mesh(loaded.simulator, text.data(), text.size(), nullptr, &square.mesh) ==
          PMDSIM_OK);
  pmdsim_frame *bright = loaded.render();
  CHECK(middle(bright, "z_m") == 2.0f);
  const std::vector<double> half{0.5, 0.5};
  square.mesh.reflectivity = half.data();
  REQUIRE(pmdsim_simulator_load_mesh(loaded.simulator, text.data(), text.size(), nullptr, &square.mesh) ==
          PMDSIM_OK);
  pmdsim_frame *dark = loaded.render();
  CHECK(middle(dark, "amplitude") == Approx(0.5 * middle(bright, "amplitude")));
  CHECK(middle(dark) == middle(bright));
  for (pmdsim_frame *frame : {bright, dark})
    pmdsim_frame_destroy(frame);
}

TEST_CASE("Channels that are asked for, alone and with the same bits") {
  const Loaded loaded;
  pmdsim_frame *all = loaded.render();
  pmdsim_render_options options{};
  options.struct_size = sizeof(options);
  options.channels = "range_m,phase_rad";
  pmdsim_frame *some = loaded.render(&options);
  std::size_t count = 0;
  REQUIRE(pmdsim_frame_channel_count(some, &count) == PMDSIM_OK);
  CHECK(count == 2);
  CHECK(floats_of(some, "phase_rad") == floats_of(all, "phase_rad"));
  CHECK(floats_of(some, "range_m") == floats_of(all, "range_m"));
  options.channels = "phase";
  pmdsim_frame *none = nullptr;
  CHECK(pmdsim_render(loaded.simulator, 0, 0, &options, &none) == PMDSIM_BAD_ARGUMENT);
  for (pmdsim_frame *frame : {all, some})
    pmdsim_frame_destroy(frame);
}

TEST_CASE("Files of frames are read") {
  const Loaded loaded;
  REQUIRE(run_pmdsim({"render", loaded.file, "-o", loaded.work / "out", "--format", "exr,h5"}).exit_code ==
          0);
  pmdsim_frame *rendered = loaded.render();
  for (const char *ending : {"exr", "h5"}) {
    INFO(ending);
    pmdsim_frame *read = nullptr;
    REQUIRE(pmdsim_frame_read((loaded.work / "out/pmd_0000." + ending).c_str(), &read) == PMDSIM_OK);
    CHECK(floats_of(read, "phase_rad") == floats_of(rendered, "phase_rad"));
    double room = 0.0;
    CHECK(pmdsim_frame_directions(read, &room, 1) == PMDSIM_BAD_ARGUMENT);
    CHECK(pmdsim_frame_destroy(read) == PMDSIM_OK);
  }
  pmdsim_frame *none = nullptr;
  CHECK(pmdsim_frame_read(loaded.file.c_str(), &none) == PMDSIM_BAD_INPUT);
  CHECK(std::string(pmdsim_error_file()) == loaded.file);
  pmdsim_frame_destroy(rendered);
}

TEST_CASE("Directions and distances make points") {
  const Loaded loaded;
  pmdsim_frame *frame = loaded.render();
  const std::vector<float> range_m = floats_of(frame, "range_m"), z_m = floats_of(frame, "z_m");
  std::vector<double> directions(3 * range_m.size());
  REQUIRE(pmdsim_frame_directions(frame, directions.data(), directions.size()) == PMDSIM_OK);
  for (std::size_t i = 0; i < range_m.size(); ++i) {
    if (std::isfinite(range_m[i]))
      CHECK(directions[3 * i + 2] * static_cast<double>(range_m[i]) == Approx(static_cast<double>(z_m[i])));
    CHECK(std::hypot(directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]) == Approx(1.0));
  }
  const char *report = nullptr;
  REQUIRE(pmdsim_frame_report(frame, &report) == PMDSIM_OK);
  CHECK(json::parse(report)["sensor"] == "pmd");
  pmdsim_frame_destroy(frame);
}

TEST_CASE("A frame outlives its simulator") {
  pmdsim_frame *frame = nullptr;
  {
    const Loaded loaded;
    frame = loaded.render();
  }
  CHECK(std::isfinite(middle(frame)));
  CHECK(pmdsim_frame_destroy(frame) == PMDSIM_OK);
}

TEST_CASE("Two simulators measure on two threads") {
  const Loaded first, second;
  std::vector<float> alone = floats_of(first.render(), "phase_rad");
  const auto measure = [&](const Loaded &on, bool &same) {
    same = true;
    for (int i = 0; i < 50; ++i) {
      pmdsim_frame *frame = nullptr;
      same = same && pmdsim_render(on.simulator, 0, 0, nullptr, &frame) == PMDSIM_OK;
      pmdsim_channel phase{};
      phase.struct_size = sizeof(phase);
      same = same && pmdsim_frame_find(frame, "phase_rad", &phase) == PMDSIM_OK &&
             std::memcmp(phase.values, alone.data(), alone.size() * sizeof(float)) == 0;
      pmdsim_frame_destroy(frame);
    }
  };
  bool first_same = false, second_same = false;
  std::thread other([&] { measure(second, second_same); });
  measure(first, first_same);
  other.join();
  CHECK(first_same);
  CHECK(second_same);
}

TEST_CASE("A frame is cancelled from another thread") {
  const Loaded slow(with(small_setup(), "[8, 8]", "[2048, 2048]"), "reference");
  pmdsim_frame *frame = nullptr;
  pmdsim_status status = PMDSIM_OK;
  std::atomic<bool> ended{false};
  std::thread rendering([&] {
    do // the other thread looks whether it has begun
      status = pmdsim_render(slow.simulator, 0, 0, nullptr, &frame);
    while (status == PMDSIM_BUSY);
    ended = true;
  });
  while (pmdsim_simulator_set(slow.simulator, "{}") != PMDSIM_BUSY && !ended)
    std::this_thread::yield();
  CHECK(pmdsim_simulator_cancel(slow.simulator) == PMDSIM_OK);
  rendering.join();
  CHECK(status == PMDSIM_CANCELLED);
  CHECK(frame == nullptr);
}
