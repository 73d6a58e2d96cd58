// How a setup asks for light that bounces, and what the scene has that such light does not heed.

#include "tests/host/input/setup/setup_fixture.h"

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

Setup bouncing(const json &count, const json &error) {
  SetupFixture fixture;
  fixture.setup["bounces"] = count;
  fixture.setup["bounce_error"] = error;
  return fixture.load();
}

std::string error_of_bounces(const json &count) {
  SetupFixture fixture;
  fixture.setup["bounces"] = count;
  return fixture.error();
}

std::string error_of_bounce_error(const json &error) {
  SetupFixture fixture;
  fixture.setup["bounce_error"] = error;
  return fixture.error();
}

// The fixture's triangle gets these materials, a primitive each.
void give_materials(SetupFixture &fixture, const json &materials) {
  fixture.setup["bounces"] = 1;
  fixture.scene["materials"] = materials;
  json &primitives = fixture.scene["meshes"][0]["primitives"];
  const json primitive = primitives[0];
  primitives.clear();
  for (std::size_t i = 0; i < materials.size(); ++i) {
    primitives.push_back(primitive);
    primitives.back()["material"] = i;
  }
}

std::vector<Warning> warnings_of_points(const json &bounces, bool triangles_too) {
  SetupFixture fixture;
  fixture.setup["bounces"] = bounces;
  fixture.scene["materials"] = {{{"extras", {{"pmdsim_point_area_m2", 1e-4}}}}};
  json &primitives = fixture.scene["meshes"][0]["primitives"];
  if (triangles_too)
    primitives.push_back(json(primitives[0]));
  primitives[0]["mode"] = 0;
  primitives[0]["material"] = 0;
  return fixture.load().warnings;
}

} // namespace

TEST_CASE("Light does not bounce unless a setup says so") {
  const Setup setup = SetupFixture().load();
  CHECK(setup.bounces == Bounces{0, 1e-3});
  CHECK_FALSE(setup.bounces.any());
}

TEST_CASE("Bounces are a number or all, their error a length") {
  CHECK(bouncing(1, "0.1mm").bounces == Bounces{1, 1e-4});
  CHECK(bouncing(1000, "1m").bounces == Bounces{1000, 1.0});
  CHECK(bouncing(3.0, "1um").bounces == Bounces{3, 1e-6});
  const Setup all = bouncing("all", "250um");
  CHECK(all.bounces.count == all_bounces);
  CHECK(all.bounces.max_error_m == Approx(2.5e-4));
  CHECK(all.as_used["bounces"] == "all");
  CHECK(all.as_used["bounce_error"] == "250um");
  CHECK(all.warnings.empty());
}

TEST_CASE("Wrong bounces and errors of them say what was expected") {
  CHECK_THAT(error_of_bounces(-1), EndsWith(" /bounces: expected an integer from 0 to 1000, found -1"));
  CHECK_THAT(error_of_bounces(1001), EndsWith("/bounces: expected an integer from 0 to 1000, found 1001"));
  CHECK_THAT(error_of_bounces(1.5), EndsWith("/bounces: expected an integer from 0 to 1000, found 1.5"));
  CHECK_THAT(error_of_bounces("some"),
             EndsWith("/bounces: expected an integer from 0 to 1000 or \"all\", found \"some\""));
  CHECK_THAT(error_of_bounces(nullptr), Contains("/bounces: expected an integer from 0 to 1000 or \"all\""));
  for (const char *text : {"0mm", "-1mm", "0.9um", "1.1m", "1", "mm", "1 mm", "1cm", ""})
    CHECK_THAT(error_of_bounce_error(text),
               EndsWith(" /bounce_error: expected a length from 1um to 1m with its unit, m, mm or "
                        "um, e.g. 1mm, found \"" +
                        std::string(text) + "\""));
  CHECK_THAT(error_of_bounce_error(1e-3),
             EndsWith("/bounce_error: expected a length from 1um to 1m with its unit, m, mm or um, e.g. 1mm, "
                      "found 0.001"));
}

TEST_CASE("Only surfaces that scatter evenly let light bounce") {
  SetupFixture fixture;
  fixture.setup["backscatter"] = "constant";
  CHECK(fixture.load().backscatter == Backscatter::constant);
  fixture.setup["bounces"] = "all";
  CHECK_THAT(fixture.error(),
             Contains(": /backscatter: expected \"lambert\" where light bounces: of \"constant\" "));
}

TEST_CASE("Materials that are no matt surfaces are named once, whether or not light bounces") {
  SetupFixture fixture;
  give_materials(fixture, {{{"name", "brass"}, {"pbrMetallicRoughness", {{"metallicFactor", 1}}}},
                           {{"name", "plaster"}},
                           {{"pbrMetallicRoughness", {{"roughnessFactor", 0.1}}}}});
  json &primitives = fixture.scene["meshes"][0]["primitives"];
  const json brass = primitives[0];
  primitives.push_back(brass);
  for (const json &bounces : {json(0), json("all")}) {
    fixture.setup["bounces"] = bounces;
    const std::vector<Warning> warnings = fixture.load().warnings;
    REQUIRE(warnings.size() == 2);
    CHECK(warnings[0].code == "gltf-metallic");
    CHECK_THAT(warnings[0].place, EndsWith("scene.gltf: /materials/0"));
    CHECK_THAT(warnings[0].text, Contains("2 of 3 materials are metallic (\"brass\", number 2), "));
    CHECK(warnings[1].code == "gltf-glossy");
    CHECK_THAT(warnings[1].text, Contains("1 of 3 materials is glossy (number 2), "));
  }
}

TEST_CASE("Materials that no mesh of the scene has are not named") {
  SetupFixture fixture;
  give_materials(fixture, json::array({{{"name", "plaster"}}}));
  fixture.scene["materials"].push_back(
      {{"name", "brass"}, {"pbrMetallicRoughness", {{"metallicFactor", 1}}}});
  CHECK(fixture.load().warnings.empty());
}

TEST_CASE("A long list of materials ends with a number") {
  const json brass{{"name", "brass"}, {"pbrMetallicRoughness", {{"metallicFactor", 1}}}};
  SetupFixture fixture;
  give_materials(fixture, std::vector<json>(23, brass));
  const Setup setup = fixture.load();
  REQUIRE(setup.warnings.size() == 1);
  CHECK_THAT(setup.warnings[0].text, Contains("23 of 23 materials are metallic (\"brass\", "));
  CHECK_THAT(setup.warnings[0].text, Contains("\"brass\" and 18 more)"));
}

TEST_CASE("Points are warned of where light bounces") {
  CHECK(warnings_of_points(0, true).empty());
  const std::vector<Warning> beside = warnings_of_points(1, true), alone = warnings_of_points("all", false);
  REQUIRE(beside.size() == 1);
  CHECK_THAT(beside[0].text, EndsWith("points neither reflect nor block light that bounces"));
  REQUIRE(alone.size() == 1);
  CHECK_THAT(alone[0].text, EndsWith("the scene has points only, and nothing bounces off points"));
}
