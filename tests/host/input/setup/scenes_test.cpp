// The setups that ship in scenes/ load, and hold what their names say.

#include "host/input/setup/setup.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

using namespace pmdsim;

namespace {

struct Contents {
  std::size_t triangles, diodes;
};

} // namespace

TEST_CASE("Every setup that ships loads, and but for what Blender adds without a warning") {
  const std::map<std::string, Contents> expected = {
      {"paper_ring.json", {2, 240}},
      {"paper_half_ring.json", {2, 120}},
      {"paper_moire.json", {2, 48}},
      {"room.json", {9950, 240}},
      {"showroom/showroom.json", {3350, 96}},
      {"bars.json", {1010, 240}},
      {"closed_box.json", {332, 240}},
      {"penumbra.json", {4, 240}},
      {"corner.json", {6, 48}},
      {"sensor.json", {9950, 1}},
      {"signal.json", {9950, 1}},
      {"light.json", {9950, 17}},
      {"motion.json", {14, 25}},
      {"blender/moving.json", {112, 30}},
      {"electronics/kinect_v2_like.json", {9950, 3}},
      {"electronics/azure_kinect_like.json", {9950, 2}},
      {"electronics/opt8241_like.json", {9950, 8}},
      {"packed/grid.json", {3200, 24}},
      {"light.json", {9950, 17}},
      {"analytic/wrap_10mhz.json", {6, 1}},
      {"analytic/on_axis_baseline.json", {8, 1}},
      {"analytic/inverse_square.json", {10, 1}},
      {"analytic/mixed_equal.json", {4, 1}},
      {"analytic/mixed_inverse_square.json", {4, 1}},
      {"analytic/cancel.json", {4, 1}},
  };
  const std::filesystem::path folder = PMDSIM_SCENES;
  std::size_t found = 0;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".json")
      continue;
    const std::string name = std::filesystem::relative(entry.path(), folder).string();
    INFO(name);
    REQUIRE(expected.contains(name));
    const Setup setup = load_setup(entry.path());
    CHECK(setup.start.scene.triangles.size() == expected.at(name).triangles);
    CHECK(diode_count(setup.start.illuminators) == expected.at(name).diodes);
    std::set<std::string> codes;
    for (const Warning &warning : setup.warnings)
      codes.insert(warning.code);
    // Blender writes a coat and a specular colour for its plainest material, and a lamp that no pose names.
    CHECK(codes == (name == "blender/moving.json"
                        ? std::set<std::string>{"gltf-clearcoat", "gltf-lights", "gltf-specular"}
                        : std::set<std::string>{}));
    ++found;
  }
  CHECK(found == expected.size());
}

TEST_CASE("The documents show the examples that ship") {
  const auto text_of = [](const std::filesystem::path &file) {
    std::ifstream stream(file);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  const std::filesystem::path folder = PMDSIM_SCENES;
  const std::filesystem::path docs = folder / ".." / "docs";
  const std::string documents = text_of(docs / "setup.md") + text_of(docs / "scenes.md");
  for (const char *name : {"sensor.json", "signal.json", "light.json", "motion.json"}) {
    const std::string text = text_of(folder / name);
    std::istringstream setup(text.substr(text.find("\n{") + 1));
    std::string shown;
    for (std::string line; std::getline(setup, line);)
      shown += "    " + line + "\n";
    INFO(name);
    CHECK(documents.find(shown) != std::string::npos);
  }
}

TEST_CASE("The room's camera looks down at what stands in it") {
  const Setup setup = load_setup(std::filesystem::path(PMDSIM_SCENES) / "room.json");
  CHECK(setup.start.scene.objects == std::vector<std::string>{"wall", "floor", "box", "sphere"});
  const glm::dvec3 view = setup.start.sensors.at(0).world_from_camera.direction({0, 0, 1});
  CHECK(view.z < -0.9);
  CHECK(view.y < -0.1);
  CHECK(view.y > -0.3);
}
