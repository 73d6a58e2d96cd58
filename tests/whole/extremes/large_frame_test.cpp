// Frames beyond what a device's buffers hold in one piece.

#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <regex>

using namespace pmdsim::test;

namespace {

// Renders the setup, which must succeed within 2 GiB, and prints what it took.
void render_large(const std::string &name, const Workspace &work, const std::string &setup,
                  const std::vector<std::string> &options = {}) {
  std::vector<std::string> arguments{"render", work.write("setup.json", setup), "--json", "-o", work / "out"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Run run = run_pmdsim(arguments);
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  fmt::print("{}: frame {:.0f} ms, peak resident memory {:.2f} GiB\n", name,
             nlohmann::json::parse(run.output)["frames"][0]["frame_ms"].get<double>(),
             double(run.peak_resident_bytes) / (1 << 30));
  CHECK(run.peak_resident_bytes < std::int64_t{2} << 30);
}

// The room, 4096 x 4096 pixels on the same chip, through a lens with distortion; 16 diodes.
std::string room_setup(const std::string &focal_length_m, const std::string &distortion) {
  std::ifstream in(scene("room.json"));
  std::string setup{std::istreambuf_iterator<char>(in), {}};
  setup = with(setup, R"("room.glb")", '"' + scene("room.glb") + '"');
  setup = with(setup, "[640, 640]", "[4096, 4096]");
  setup = with(setup, "[45e-6, 45e-6]", "[7.03125e-6, 7.03125e-6]");
  setup = with(setup, R"("focal_length_m": 0.02494)",
               R"("focal_length_m": )" + focal_length_m + R"(, "distortion": )" + distortion);
  return std::regex_replace(setup, std::regex(R"("count": 48)"), R"("count": 3)");
}

} // namespace

TEST_CASE("4096 x 4096 pixels with 240 diodes stay below 2 GiB", "[long]") {
  // The simulator itself refuses a storage buffer above the device's limit, 128 MiB on lavapipe.
  const Workspace work;
  const std::string ring = R"({"rings": [{"radius_m": 0.146, "count": 240}]})";
  std::string setup = with(small_setup(), "[8, 8]", "[4096, 4096]");
  setup = with(setup, "[45e-6, 45e-6]", "[1e-6, 1e-6]");
  setup = with(setup, "0.0018", "0.02048"); // the wall fills the view
  setup = with(setup, R"({"rings": [{"radius_m": 0.146, "count": 16}]})", ring);
  work.write("wall.gltf", wall_gltf());
  render_large("4096 x 4096 x 240", work, setup);
}

TEST_CASE("4096 x 4096 pixels through a barrel and a fisheye stay below 2 GiB", "[long]") {
  const Workspace work;
  const std::vector<std::string> quickly{"--format", "npy"};
  render_large("4096 x 4096 x 15, barrel", work,
               room_setup("0.02494", R"({"model": "brown", "k1": -0.18, "p1": 0.01})"), quickly);
  render_large("4096 x 4096 x 15, fisheye", work,
               room_setup("0.0137", R"({"model": "fisheye", "k1": -0.01})"), quickly);
}
