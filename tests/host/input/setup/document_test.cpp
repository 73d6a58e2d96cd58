// Changes to a setup by paths and values.

#include "host/input/setup/document.h"
#include "tests/host/input/setup/setup_fixture.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using nlohmann::json;

namespace {

SetupDocument changed(const json &values) {
  SetupDocument document{"setup.json", test::SetupFixture().setup};
  change(document, values);
  return document;
}

std::string refusal(const json &values) {
  return test::input_error_of([&] { changed(values); });
}

} // namespace

TEST_CASE("A value is set by index, by name, with and without the first slash") {
  for (const char *path : {"sensors/0/taps", "/sensors/0/taps", "sensors/pmd/taps"})
    CHECK(changed({{path, 8}}).json["sensors"][0]["taps"] == 8);
}

TEST_CASE("Objects on the way are made, elements of arrays are not") {
  CHECK(changed({{"sensors/0/electronics/preset", "kinect_v2_like"}})
            .json["sensors"][0]["electronics"]["preset"] == "kinect_v2_like");
  CHECK(changed({{"nodes/a~1b/pose/trajectory", "x.tum"}}).json["nodes"]["a/b"]["pose"]["trajectory"] ==
        "x.tum");
  CHECK(refusal({{"sensors/1/taps", 8}}) ==
        "setup.json: /sensors: cannot set \"sensors/1/taps\": expected the index "
        "or the name of one of 1, found \"1\"");
  CHECK(refusal({{"sensors/-/taps", 8}}).find("found \"-\"") != std::string::npos);
}

TEST_CASE("A path that leads nowhere is refused, and nothing is changed") {
  SetupDocument document{"setup.json", test::SetupFixture().setup};
  const json before = document.json;
  for (const char *path : {"", "sensors/0/name/x", "~3", "sensors/0/resolution/2"}) {
    INFO(path);
    CHECK_THROWS_AS(change(document, {{"backscatter", "constant"}, {path, 1}}), Error);
    CHECK(document.json == before);
  }
  CHECK_THROWS_AS(change(document, json::array()), Error);
}

TEST_CASE("A changed setup is loaded with presets and defaults, and scenes are read once") {
  test::SetupFixture fixture;
  fixture.load();
  SetupDocument document = read_setup_document(fixture.folder.path() / "setup.json");
  SetupLoader loader;
  const std::size_t triangles = loader.load(document).start.scene.triangles.size();
  fixture.folder.write("scene.gltf", "no scene any more");
  change(document, {{"sensors/0/electronics",
                     {{"preset", "kinect_v2_like"}, {"integration_time_s", 1e-3}, {"lens_f_number", 1.1}}},
                    {"frames/start_s", 0.5}});
  const Setup setup = loader.load(document);
  CHECK(setup.start.scene.triangles.size() == triangles);
  CHECK(setup.start.sensors[0].electronics.has_value());
  CHECK(setup.frames.start_s == 0.5);
  CHECK_THROWS_AS(SetupLoader().load(document), Error);
}

TEST_CASE("A change to null takes a key out, and its default holds") {
  test::SetupFixture fixture;
  fixture.sensor()["samples"] = 3;
  SetupDocument document{"setup.json", fixture.setup};
  change(document, {{"sensors/0/samples", nullptr}, {"sensors/0/taps", nullptr}, {"frames/count", nullptr}});
  fixture.sensor().erase("samples");
  CHECK(document.json == fixture.setup);
  change(document,
         {{"illuminators/ring/diodes", {{"file", "d.csv"}}}, {"illuminators/ring/pattern", nullptr}});
  CHECK(document.json["illuminators"][0].size() == 2);
  const auto told = [&](const std::string &path) {
    return test::input_error_of([&] { change(document, {{path, nullptr}}, "--set"); });
  };
  CHECK(told("sensors/0/focal_lengt_m")
            .find("--set cannot set \"sensors/0/focal_lengt_m\": there is no key "
                  "\"focal_lengt_m\" to remove, did you mean \"focal_length_m\"?") != std::string::npos);
  CHECK(told("sensors/1/taps").find("expected the index or the name") != std::string::npos);
  CHECK(told("sensors/0/name/first").find("expected an object or an array here") != std::string::npos);
}

TEST_CASE("A scene that is given takes the place of a file") {
  test::SetupFixture fixture;
  auto scene = std::make_shared<Scene>();
  scene->positions_m = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}};
  scene->surfaces.emplace_back();
  scene->objects = {"one"};
  scene->triangles = {{{0, 1, 2}, 0, 0}};
  fixture.setup.erase("scene");
  SetupDocument document{"setup.json", fixture.setup};
  CHECK(SetupLoader().load(document, scene).start.scene == *scene);
  change(document, {{"sensors/0/pose/node", "Camera"}});
  CHECK(test::input_error_of([&] { SetupLoader().load(document, scene); }).find("no node \"Camera\"") !=
        std::string::npos);
}
