// How wide lavapipe's vectors are: never wider than 256 bits, as Mesa crashes where such fragments meet
// attachments; and what was compiled for one width is not taken for another.

#include "tests/program/program.h"

#include <algorithm>
#include <catch2/catch.hpp>
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

} // namespace

TEST_CASE("a width of at most 256 bits is used, a wider one is taken back") {
  if (device_of({}, "128").find("128 bits") == std::string::npos)
    return; // not lavapipe
  CHECK(device_of({"--no-wide-vectors"}, "128").find("128 bits") != std::string::npos);
  CHECK(device_of({}, "512").find("256 bits") != std::string::npos);
  CHECK(device_of({"--no-wide-vectors"}, "512").find("256 bits") != std::string::npos);
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
