// Illuminators as a setup gives them: diagrams from files, their roll, several of them and their phases.

#include "host/input/diagram/diode_file.h"
#include "tests/host/input/setup/setup_fixture.h"
#include "tests/support/units.h"

#include <numbers>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

const std::string diode_header = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern";
const std::string small_diagram = "angle_deg,relative\n0,2\n90,1\n";

json named(json illuminator, const std::string &name) {
  illuminator["name"] = name;
  return illuminator;
}

double phase_of(double degrees) {
  SetupFixture fixture;
  fixture.illuminator()["modulation_phase_deg"] = degrees;
  return fixture.load().start.illuminators.at(0).modulation_phase_rad;
}

} // namespace

TEST_CASE("Across is +x, carried along with the axis, then turned about it") {
  CHECK(diode_across({0, 0, 1}, 0) == glm::dvec3(1, 0, 0));
  CHECK(diode_across({0, 0, -1}, 0) == glm::dvec3(1, 0, 0));
  CHECK(distance(diode_across({1, 0, 0}, 0), {0, 0, -1}) < 1e-15);
  CHECK(distance(diode_across({0, 1, 0}, 0), {1, 0, 0}) < 1e-15);
  CHECK(distance(diode_across({0, 0, 1}, 90 * degree), {0, 1, 0}) < 1e-15);
  CHECK(distance(diode_across({0, 0, -1}, 90 * degree), {0, -1, 0}) < 1e-15);
  CHECK(distance(diode_across({0, 1, 0}, 90 * degree), {0, 0, -1}) < 1e-15);
  const double s = std::sqrt(0.5);
  CHECK(distance(diode_across({s, 0, s}, 0), {s, 0, -s}) < 1e-15);
}

TEST_CASE("Across is at right angles to any axis") {
  std::mt19937 random(20070605);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const double flat = i % 2 == 0 ? 1.0 : 1e-9; // close to +z and -z too
    const glm::dvec3 axis =
        glm::normalize(glm::dvec3(flat * normal(random), flat * normal(random), normal(random)));
    const glm::dvec3 across = diode_across(axis, normal(random));
    CHECK(std::abs(glm::length(across) - 1.0) < 1e-14);
    CHECK(std::abs(glm::dot(across, axis)) < 1e-14);
  }
}

TEST_CASE("All diodes of an illuminator share the diagram of its file") {
  SetupFixture fixture;
  fixture.folder.write("led.csv", small_diagram);
  fixture.illuminator()["pattern"] = {{"file", "led.csv"}};
  const Setup setup = fixture.load();
  const std::vector<Diode> diodes = diodes_of(setup);
  REQUIRE(diodes.size() == 8);
  for (const Diode &diode : diodes) {
    CHECK(diode.pattern.kind == Pattern::Kind::diagram);
    CHECK(diode.pattern.diagram == diodes[0].pattern.diagram);
    CHECK(diode.across == glm::dvec3(1, 0, 0));
  }
  CHECK(diodes[0].pattern.diagram->relative == std::vector{1.0, 0.5});
  CHECK(setup.warnings.empty());
  CHECK(setup.as_used["illuminators"][0]["pattern"] == json({{"file", "led.csv"}, {"roll_deg", 0}}));
}

TEST_CASE("An illuminator's diagrams roll about the axes of its diodes") {
  SetupFixture fixture;
  fixture.folder.write("led.csv", small_diagram);
  fixture.illuminator()["pattern"] = {{"file", "led.csv"}, {"roll_deg", 30}};
  for (const Diode &diode : diodes_of(fixture.load()))
    CHECK(distance(diode.across, {std::sqrt(0.75), 0.5, 0}) < 1e-15);
  fixture.illuminator()["pattern"] = {{"order", 3}, {"roll_deg", 30}};
  CHECK_THAT(fixture.error(), Contains("/illuminators/0/pattern: unknown key \"roll_deg\""));
}

TEST_CASE("A diode file names diagrams in its own folder, with a roll each") {
  SetupFixture fixture;
  std::filesystem::create_directory(fixture.folder.path() / "lamp");
  fixture.folder.write("lamp/led.csv", small_diagram);
  fixture.folder.write("lamp/940nm.csv", "angle_deg,relative\n0,1\n10,1\n");
  fixture.folder.write("lamp/diodes.csv", diode_header + ",roll_deg\n" +
                                              "0,0,0,0,0,1,1,led.csv,0\n"
                                              "1,0,0,0,0,1,1,940nm.csv,90\n"
                                              "2,0,0,1,0,0,1,./led.csv,90\n"
                                              "3,0,0,0,0,1,1,2.5,0\n"
                                              "4,0,0,0,0,1,1,isotropic,0\n");
  fixture.illuminator()["diodes"] = {{"file", "lamp/diodes.csv"}};
  const std::vector<Diode> diodes = diodes_of(fixture.load());
  REQUIRE(diodes.size() == 5);
  CHECK(diodes[0].pattern.diagram == diodes[2].pattern.diagram);
  CHECK(diodes[1].pattern.diagram->theta_rad.back() == Approx(10 * degree));
  CHECK(diodes[0].across == glm::dvec3(1, 0, 0));
  CHECK(distance(diodes[1].across, {0, 1, 0}) < 1e-15);
  CHECK(distance(diodes[2].across, {0, 1, 0}) < 1e-15);
  CHECK(diodes[3].pattern.kind == Pattern::Kind::cosine);
  CHECK(diodes[4].pattern.kind == Pattern::Kind::isotropic);
}

TEST_CASE("Diagram files that cannot be read are named where they are asked for") {
  SetupFixture fixture;
  fixture.illuminator()["pattern"] = {{"file", "absent.ies"}};
  CHECK_THAT(fixture.error(),
             Contains(": /illuminators/0/pattern/file: ") && EndsWith("absent.ies\": no such file"));
  fixture.folder.write("absent.ies", "IESNA91\n");
  CHECK_THAT(fixture.error(), Contains("absent.ies:1: expected a line TILT="));
  fixture.illuminator().erase("pattern");
  fixture.illuminator()["diodes"] = {{"file", "diodes.csv"}};
  const auto error_with = [&](const std::string &row) {
    fixture.folder.write("diodes.csv", diode_header + ",roll_deg\n" + row + "\n");
    return fixture.error();
  };
  CHECK_THAT(error_with("0,0,0,0,0,1,1,none.csv,0"),
             Contains("diodes.csv:2: ") && EndsWith("none.csv\": no such file"));
  CHECK_THAT(error_with("0,0,0,0,0,1,1,1,3601"),
             EndsWith("diodes.csv:2:17: roll_deg: expected a number from -3600 to 3600, found \"3601\""));
  CHECK_THAT(error_with("0,0,0,0,0,1,1,1,"),
             EndsWith("diodes.csv:2:17: roll_deg: expected a number, found \"\""));
}

TEST_CASE("A diagram that is dark on its axis is a warning, once for all who name it") {
  SetupFixture fixture;
  fixture.folder.write("ring.csv", "angle_deg,relative\n0,0\n45,2\n90,0\n");
  fixture.illuminator()["pattern"] = {{"file", "ring.csv"}};
  fixture.setup["illuminators"].push_back(named(fixture.illuminator(), "second"));
  const Setup setup = fixture.load();
  REQUIRE(setup.warnings.size() == 1);
  CHECK(setup.warnings[0].code == "dark-diagram-axis");
  CHECK_THAT(setup.warnings[0].place, EndsWith("ring.csv"));
  CHECK(setup.start.illuminators[0].diodes[0].pattern.diagram ==
        setup.start.illuminators[1].diodes[0].pattern.diagram);
}

TEST_CASE("The diode cos^3 that ships is the same as a table and as IES") {
  SetupFixture fixture;
  const std::filesystem::path scenes = PMDSIM_SCENES;
  const auto diagram_of = [&](const char *name) {
    fixture.illuminator()["pattern"] = {{"file", (scenes / name).string()}};
    return diodes_of(fixture.load()).at(0).pattern.diagram;
  };
  const auto csv = diagram_of("led_cos3.csv");
  const auto ies = diagram_of("led_cos3.ies");
  CHECK(csv->theta_rad == ies->theta_rad);
  CHECK(csv->phi_rad == ies->phi_rad);
  CHECK(csv->relative == ies->relative);
  REQUIRE(csv->theta_rad.size() == 91);
  for (std::size_t i = 0; i < 91; ++i) {
    CHECK(csv->theta_rad[i] == Approx(static_cast<double>(i) * degree));
    CHECK(csv->relative[i] == Approx(std::pow(std::cos(csv->theta_rad[i]), 3)).margin(1e-9));
  }
}

TEST_CASE("Several illuminators stand where their poses say, with a phase each") {
  SetupFixture fixture;
  fixture.illuminator()["modulation_phase_deg"] = 90;
  json lamp = {{"name", "lamp"}, {"diodes", "monostatic"}, {"modulation_phase_deg", -90}};
  lamp["pose"] = {{"position_m", {1, 2, 3}}, {"look_at_m", {1, 2, 0}}};
  fixture.setup["illuminators"].push_back(lamp);
  fixture.setup["illuminators"].push_back(
      {{"name", "node"}, {"diodes", "monostatic"}, {"pose", {{"node", "object"}}}});
  const Setup setup = fixture.load();
  const std::vector<Illuminator> &lights = setup.start.illuminators;
  REQUIRE(lights.size() == 3);
  CHECK(lights[0].diodes.size() == 8);
  CHECK(lights[0].modulation_phase_rad == Approx(std::numbers::pi / 2));
  CHECK(lights[1].name == "lamp");
  CHECK(lights[1].modulation_phase_rad == Approx(3 * std::numbers::pi / 2));
  CHECK(lights[1].world_from_illuminator.translation_m == glm::dvec3(1, 2, 3));
  CHECK(lights[2].modulation_phase_rad == 0.0);
  CHECK(setup.warnings.empty());
}

TEST_CASE("An illuminator's phase is within one turn") {
  CHECK(phase_of(0) == 0.0);
  CHECK(phase_of(360) == 0.0);
  CHECK(phase_of(-1e-300) == 0.0);
  CHECK(phase_of(725) == Approx(5 * degree));
  CHECK(phase_of(-3.6e6 + 0.5) == Approx(0.5 * degree));
  CHECK(phase_of(359.99999999999994) < 2 * std::numbers::pi);
}

TEST_CASE("Illuminators that are refused") {
  SetupFixture fixture;
  fixture.setup["illuminators"].push_back(fixture.illuminator());
  CHECK_THAT(fixture.error(),
             EndsWith("/illuminators/1/name: expected a name that no other illuminator has, found "
                      "\"ring\""));
  fixture.setup["illuminators"][1]["name"] = "second";
  fixture.setup["illuminators"][1]["diodes"]["rings"][0]["count"] = 99'992;
  CHECK_NOTHROW(fixture.load());
  fixture.setup["illuminators"][1]["diodes"]["rings"][0]["count"] = 99'993;
  CHECK_THAT(fixture.error(),
             EndsWith("/illuminators/1/diodes: expected at most 100000 diodes in all illuminators"));
}

TEST_CASE("Illuminators with a frequency of their own are another camera's") {
  SetupFixture fixture;
  json lamp = {{"name", "lamp"}, {"diodes", "monostatic"}, {"modulation_hz", 31e6}};
  fixture.setup["illuminators"].insert(fixture.setup["illuminators"].begin(), lamp);
  const Setup setup = fixture.load();
  REQUIRE(setup.start.illuminators.size() == 1);
  CHECK(setup.start.illuminators[0].name == "ring");
  REQUIRE(setup.start.others.size() == 1);
  CHECK(setup.start.others[0].modulation_hz == 31e6);
  CHECK(setup.start.others[0].illuminator.name == "lamp");
  REQUIRE(setup.warnings.size() == 1);
  CHECK_THAT(setup.warnings[0].text, Contains("sensor pmd: illuminators with modulation_hz are left out"));
  fixture.illuminator()["name"] = "ring";
  CHECK_THAT(fixture.error(), Contains("/illuminators/1/name: "));
  fixture.setup["illuminators"] = json::array({lamp});
  CHECK_THAT(fixture.error(), Contains("/illuminators: expected at least one without modulation_hz"));
  lamp["modulation_hz"] = 0.5;
  fixture.setup["illuminators"].push_back(lamp);
  CHECK_THAT(fixture.error(), Contains("/illuminators/1/modulation_hz: "));
}
