// What a setup most probably does not mean is told, and what it may well mean is not.

#include "host/input/setup/plausibility.h"
#include "tests/host/input/setup/setup_fixture.h"

#include <catch2/catch.hpp>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

std::vector<std::string> codes_of(const Setup &setup) {
  std::vector<std::string> codes;
  for (const Warning &warning : setup.warnings)
    codes.push_back(warning.code);
  return codes;
}

using Codes = std::vector<std::string>;

// A box about `centre_m`, its fronts outside, or inside where `is_room`.
json box(const std::vector<float> &centre_m, float size_m, bool is_room = false, bool both_sides = false) {
  std::vector<float> positions;
  for (unsigned i = 0; i < 8; ++i)
    for (unsigned axis = 0; axis < 3; ++axis)
      positions.push_back(centre_m[axis] + ((i >> axis & 1u) != 0 ? 0.5f : -0.5f) * size_m);
  std::vector<std::uint16_t> indices{0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                     2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  if (is_room)
    for (std::size_t i = 0; i < indices.size(); i += 3)
      std::swap(indices[i], indices[i + 1]);
  json gltf = document(positions, indices, 4);
  gltf["materials"] = json::array({{{"doubleSided", both_sides}}});
  gltf["meshes"][0]["primitives"][0]["material"] = 0;
  return gltf;
}

Codes codes_with_scene(const json &scene, const json &illuminator_pose = nullptr) {
  SetupFixture fixture;
  fixture.scene = scene;
  if (!illuminator_pose.is_null())
    fixture.illuminator()["pose"] = illuminator_pose;
  return codes_of(fixture.load());
}

} // namespace

TEST_CASE("A focal length in millimetres, or a pitch, is told") {
  SetupFixture fixture;
  fixture.sensor()["focal_length_m"] = 10;
  const Setup setup = fixture.load();
  REQUIRE(codes_of(setup) == Codes{"unusual-value"}); // and no second one of what it sees
  CHECK_THAT(setup.warnings[0].place, Catch::EndsWith("setup.json: /sensors/0/focal_length_m"));
  fixture.sensor()["focal_length_m"] = 1;
  fixture.sensor()["pixel_pitch_m"] = {1e-5, 1e-5};
  CHECK(codes_of(fixture.load()) == Codes{"field-of-view"});
  fixture.sensor()["resolution"] = {8, 8}; // three pixels of a narrow view are a test of somebody
  CHECK(fixture.load().warnings.empty());
}

TEST_CASE("Diodes in millimetres are told, of a ring and of a table") {
  SetupFixture fixture;
  fixture.illuminator()["diodes"]["rings"][0]["radius_m"] = 25;
  Setup setup = fixture.load();
  REQUIRE(codes_of(setup) == Codes{"unusual-value"});
  CHECK_THAT(setup.warnings[0].place, Catch::EndsWith("setup.json: /illuminators/0/diodes"));
  CHECK(setup.warnings[0].text ==
        "8 of 8 diodes lie far away, up to 25 m from the illuminator's origin: are these "
        "millimetres? 25 mm are written 0.025");
  fixture.illuminator()["diodes"]["rings"][0]["radius_m"] = 2; // a board as large as a door
  CHECK(fixture.load().warnings.empty());
  fixture.illuminator()["diodes"] = {{"file", "board.csv"}};
  const std::string header = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n";
  fixture.folder.write("board.csv", header + "0,0,0,0,0,1,1,1\n3,4,0,0,0,1,1,1\n");
  setup = fixture.load();
  REQUIRE(codes_of(setup) == Codes{"unusual-value"});
  CHECK_THAT(setup.warnings[0].place, Catch::EndsWith("board.csv"));
  CHECK_THAT(setup.warnings[0].text, Catch::StartsWith("1 of 2 diodes lie far away, up to 5 m"));
}

TEST_CASE("A scene in millimetres is told, and a large one in metres is not") {
  SetupFixture fixture;
  fixture.scene["nodes"][0]["scale"] = {2000, 2000, 2000};
  const Setup setup = fixture.load();
  REQUIRE(codes_of(setup) == Codes{"scene-in-millimetres"});
  CHECK_THAT(setup.warnings[0].place, Catch::EndsWith("setup.json: /scene"));
  fixture.scene["nodes"][0]["scale"] = {100, 100, 100};
  CHECK(fixture.load().warnings.empty());
  fixture.scene["nodes"][0]["scale"] = {2000, 2000, 2}; // a wall, however large
  CHECK(fixture.load().warnings.empty());
}

TEST_CASE("A parent of scale 0.001 puts a scene in millimetres right, as its warning says") {
  SetupFixture fixture;
  json &nodes = fixture.scene["nodes"];
  nodes[0]["translation"] = {0, 0, -1500};
  nodes[0]["scale"] = {2000, 2000, 2000};
  const Setup setup = fixture.load();
  REQUIRE(codes_of(setup) == Codes{"scene-in-millimetres"});
  CHECK_THAT(setup.warnings[0].text, Catch::Contains("put all root nodes below one node of scale 0.001"));
  const json roots = fixture.scene["scenes"][0]["nodes"];
  fixture.scene["scenes"][0]["nodes"] = {nodes.size()};
  nodes.push_back({{"scale", {0.001, 0.001, 0.001}}, {"children", roots}});
  const Setup mended = fixture.load();
  CHECK(mended.warnings.empty());
  for (std::size_t i = 0; i < mended.start.scene.positions_m.size(); ++i)
    CHECK(glm::distance(mended.start.scene.positions_m[i], 1e-3 * setup.start.scene.positions_m[i]) < 1e-9);
}

TEST_CASE("A rough metal is told where Blender wrote the file") {
  SetupFixture fixture;
  fixture.scene["materials"] = {{{"name", "steel"}, {"pbrMetallicRoughness", {{"roughnessFactor", 0.8}}}}};
  fixture.scene["meshes"][0]["primitives"][0]["material"] = 0;
  CHECK(fixture.load().warnings.empty());
  fixture.scene["asset"]["generator"] = 7; // which no file should have
  CHECK(fixture.load().warnings.empty());
  fixture.scene["asset"]["generator"] = "Khronos glTF Blender I/O v4.2.57";
  CHECK(codes_of(fixture.load()) == Codes{"gltf-metallic"});
}

TEST_CASE("Diodes that are all turned away are told") {
  SetupFixture fixture;
  fixture.illuminator()["pattern"] = {{"order", 1}};
  CHECK(fixture.load().warnings.empty());
  fixture.illuminator()["pose"] = {{"position_m", {0, 0, 0}}, {"look_at_m", {0, 0, 1}}};
  const Setup setup = fixture.load();
  REQUIRE(codes_of(setup) == Codes{"diodes-turned-away"});
  CHECK(setup.warnings[0].place == "sensor pmd");
  CHECK_THAT(setup.warnings[0].text, Catch::StartsWith("all 8 diodes are turned away"));
  fixture.illuminator()["pose"]["look_at_m"] = {1, 0, 0}; // to the side: they light one half of the view
  CHECK(fixture.load().warnings.empty());
  fixture.illuminator()["pose"] = {{"position_m", {0, 0, -5}}, {"look_at_m", {0, 0, 1}}}; // from behind
  CHECK(fixture.load().warnings.empty());
  fixture.illuminator()["pose"] = {{"position_m", {0, 0, 0}}, {"look_at_m", {0, 0, 1}}};
  fixture.illuminator()["pattern"] = {{"isotropic", true}};
  CHECK(fixture.load().warnings.empty());
}

TEST_CASE("A lens within a body is told, and one within a room is not") {
  CHECK(codes_with_scene(box({0, 0, 0}, 0.5f)) == Codes{"sensor-inside-body"});
  CHECK(codes_with_scene(box({0, 0, 0}, 0.5f, false, true)) == Codes{"sensor-inside-body"});
  CHECK(codes_with_scene(box({0, 0, 0}, 4.0f)) == Codes{"sensor-inside-body"});
  CHECK(codes_with_scene(box({0, 0, 0}, 4.0f, false, true)).empty()); // a room that shows both sides
  CHECK(codes_with_scene(box({0, 0, 0}, 4.0f, true)).empty());
  CHECK(codes_with_scene(box({0, 0, -2}, 0.5f)).empty());
  json open = box({0, 0, 0}, 0.5f);
  open["accessors"][1]["count"] = 30; // one side is missing
  CHECK(codes_with_scene(open).empty());
}

TEST_CASE("Diodes within a body are told with their number") {
  const json pose = {{"position_m", {0, 0, -2}}, {"look_at_m", {0, 0, 0}}};
  CHECK(codes_with_scene(box({0, 0, -2}, 0.5f), pose) == Codes{"diode-inside-body"});
  SetupFixture fixture;
  fixture.scene = box({0, 0, -2}, 0.1f); // the ring is wider than that
  fixture.illuminator()["pose"] = pose;
  CHECK(fixture.load().warnings.empty());
  fixture.illuminator()["pose"]["position_m"] = {0.1, 0, -2};
  const Setup setup = fixture.load();
  REQUIRE(codes_of(setup) == Codes{"diode-inside-body"});
  CHECK_THAT(setup.warnings[0].place, Catch::EndsWith("setup.json: /illuminators/0"));
  CHECK_THAT(setup.warnings[0].text, Catch::StartsWith("2 of 8 diodes lie inside the body \"object\""));
  fixture.setup["shadows"] = "off";
  CHECK(fixture.load().warnings.empty());
}

TEST_CASE("Whether places are within a body is found wherever they are") {
  SetupFixture fixture;
  fixture.scene = box({1, 2, -3}, 2.0f);
  const Scene scene = fixture.load().start.scene;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> far(-1.5, 1.5);
  std::vector<glm::dvec3> places_m;
  for (int i = 0; i < 2000; ++i)
    places_m.push_back(glm::dvec3(1, 2, -3) + glm::dvec3(far(random), far(random), far(random)));
  const std::vector<std::uint32_t> around = bodies_around(scene, places_m, 1.0);
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    const glm::dvec3 from_centre_m = glm::abs(places_m[i] - glm::dvec3(1, 2, -3));
    const bool is_inside = glm::all(glm::lessThan(from_centre_m, glm::dvec3(1.0)));
    REQUIRE((around[i] == 0) == is_inside);
  }
}
