// lavapipe's vectors of 512 bits, where the processor has them: frames are the same, and what was compiled
// for one width is not taken for another. (Mesa crashes where fragments of that width meet attachments.)

#include "tests/program/program.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

const std::string variable = "LP_NATIVE_VECTOR_WIDTH";

std::string device_of(const std::vector<std::string> &more, const std::string &width) {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  std::vector<std::string> arguments{"bench", work.write("setup.json", small_setup()), "--mode", "exact",
                                     "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Run run = run_pmdsim(arguments, {.environment = {{variable, width}, {"HOME", work / "home"}}});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.output)["device"];
}

// `bench` compares with the reference before it says anything.
double error_m(const std::string &setup, const std::string &width) {
  const Run run =
      run_pmdsim({"bench", setup, "--mode", "exact", "--json"}, {.environment = {{variable, width}}});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.output)["results"][0]["error_found_m"];
}

} // namespace

TEST_CASE("a width that was asked for is used, and --no-wide-vectors takes it back") {
  if (device_of({}, "512").find("512 bits") == std::string::npos)
    return; // not lavapipe, or a processor without them
  CHECK(device_of({"--no-wide-vectors"}, "512").find("256 bits") != std::string::npos);
  CHECK(device_of({"--no-wide-vectors"}, "128").find("128 bits") != std::string::npos);
}

TEST_CASE("a small frame with vectors of 512 bits is as exact as with 256") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  CHECK(error_m(setup, "512") <= 1.5 * error_m(setup, "256") + 1e-9);
}

TEST_CASE("frames with vectors of 512 bits are as exact as with 256", "[long]") {
  // One sample a pixel; shadows and several frequencies; a lens with distortion, tilt and fill factor; masks.
  for (const std::string setup : {"paper_ring.json", "signal.json", "sensor.json", "light.json"}) {
    INFO(setup);
    CHECK(error_m(scene(setup), "512") <= 1.5 * error_m(scene(setup), "256") + 1e-9);
  }
}

TEST_CASE("each width has its own cache of shaders") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  for (const std::string width : {"128", "256"})
    CHECK(
        run_pmdsim({"render", setup, "-o", work / "out"}, {.environment = {{variable, width},
                                                                           {"XDG_CACHE_HOME", work / "cache"},
                                                                           {"MESA_SHADER_CACHE_DIR", ""}}})
            .exit_code == 0);
  const std::vector<std::string> files = work.files("cache");
  const auto has = [&](const std::string &width) {
    return std::ranges::any_of(files, [&](const std::string &file) {
      return file.find("pmdsim_lavapipe_" + width) != std::string::npos;
    });
  };
  CHECK(has("128"));
  CHECK(has("256"));
}
