// Frames beyond what a device's buffers hold in one piece.

#include "tests/command_line/program.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;

TEST_CASE("4096 x 4096 pixels with 240 diodes stay below 2 GiB") {
  // The simulator itself refuses a storage buffer above the device's limit, 128 MiB on lavapipe.
  const Workspace work;
  const std::string ring = R"({"rings": [{"radius_m": 0.146, "count": 240}]})";
  std::string setup = with(small_setup(), "[8, 8]", "[4096, 4096]");
  setup = with(setup, "[45e-6, 45e-6]", "[1e-6, 1e-6]");
  setup = with(setup, "0.0018", "0.02048"); // the wall fills the view
  setup = with(setup, R"({"rings": [{"radius_m": 0.146, "count": 16}]})", ring);
  work.write("wall.gltf", wall_gltf());
  const Run run = run_pmdsim({"render", work.write("setup.json", setup), "--json", "-o", work / "out"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  fmt::print("4096 x 4096 x 240: frame {:.0f} ms, peak resident memory {:.2f} GiB\n",
             nlohmann::json::parse(run.output)["frames"][0]["frame_ms"].get<double>(),
             double(run.peak_resident_bytes) / (1 << 30));
  CHECK(run.peak_resident_bytes < std::int64_t{2} << 30);
}
