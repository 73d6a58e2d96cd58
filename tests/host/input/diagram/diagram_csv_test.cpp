#include "host/input/diagram/radiation_law.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/units.h"

#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;

namespace {

Diagram read_csv(const std::string &text, std::vector<Warning> *warnings = nullptr) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("led.csv", text);
  DiagramFiles files;
  const Diagram diagram = *files.read(file, Place{file});
  if (warnings != nullptr)
    *warnings = files.warnings();
  else
    CHECK(files.warnings().empty());
  return diagram;
}

std::string csv_error(const std::string &text) {
  return test::input_error_of([&] { read_csv(text); });
}

void check_close(const std::vector<double> &found, const std::vector<double> &expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    CHECK(found[i] == Approx(expected[i]).margin(1e-15));
}

const std::string one = "angle_deg,relative\n";
const std::string two = "theta_deg,phi_deg,relative\n";

} // namespace

TEST_CASE("A diagram's table over the angle to the axis is the same all around") {
  const Diagram diagram = read_csv("relative, angle_deg\n4, 0\n3, 30\n\n+1e0, 90\r\n0,180");
  check_close(diagram.theta_rad, {0, 30 * degree, std::numbers::pi / 2, std::numbers::pi});
  CHECK(diagram.theta_rad.back() == std::numbers::pi);
  CHECK(diagram.phi_rad == std::vector{0.0});
  CHECK(diagram.relative == std::vector{1.0, 0.75, 0.25, 0.0});
}

TEST_CASE("A diagram's table over both angles comes in any order") {
  const Diagram diagram = read_csv("phi_deg,relative,theta_deg\n"
                                   "90,1,60\n0,4,0\n270,3,60\n90,4,0\n0,2,60\n270,4,0\n");
  check_close(diagram.theta_rad, {0, 60 * degree});
  check_close(diagram.phi_rad, {0, 90 * degree, 270 * degree});
  CHECK(diagram.relative == std::vector{1.0, 1.0, 1.0, 0.5, 0.25, 0.75});
}

TEST_CASE("A diagram's phi of 360 is 0 again") {
  const Diagram diagram = read_csv(two + "0,0,2\n0,180,2\n0,360,2\n45,0,1\n45,180,0.5\n45,360,1\n");
  check_close(diagram.phi_rad, {0, std::numbers::pi});
  CHECK(diagram.relative == std::vector{1.0, 1.0, 0.5, 0.25});
  CHECK_THAT(
      csv_error(two + "0,0,2\n0,180,2\n0,360,2\n45,0,1\n45,180,0.5\n45,360,1.1\n"),
      EndsWith("led.csv:7: expected at 360 degrees what 0 has, 1 (within 1 % of the maximum), found 1.1"));
  CHECK_THAT(csv_error(two + "0,10,2\n0,360,2\n45,10,1\n45,360,1\n"),
             EndsWith("led.csv:3: expected an angle below 360 about the axis, or 0 beside 360"));
}

TEST_CASE("All phi of a diagram's axis have their mean") {
  const Diagram diagram =
      read_csv(two + "0,0,1.004\n0,120,1.001\n0,240,0.995\n90,0,0\n90,120,0.5\n90,240,0\n");
  check_close(diagram.relative, {1, 1, 1, 0, 0.5, 0});
  CHECK_THAT(
      csv_error(two + "0,0,1\n0,120,0.98\n90,0,0\n90,120,0\n"),
      EndsWith("led.csv:3: expected on the axis, which is one direction, the same value all around (within "
               "1 % of the maximum), found 1 and 0.98"));
}

TEST_CASE("A diagram that is dark on its axis is 1 at its maximum, and a warning") {
  std::vector<Warning> warnings;
  CHECK(read_csv(one + "0,0\n30,4\n60,2\n", &warnings).relative == std::vector{0.0, 1.0, 0.5});
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].code == "dark-diagram-axis");
  CHECK_THAT(warnings[0].place, EndsWith("led.csv"));
  CHECK(read_csv(one + "90,1\n180,4\n", &warnings).relative == std::vector{0.25, 1.0});
  CHECK(warnings.size() == 1);
  CHECK(read_csv(one + "0,1e-7\n30,1\n", &warnings).relative[1] == 1.0);
  CHECK(warnings.size() == 1);
  CHECK(read_csv(one + "0,1e-5\n30,1\n", &warnings).relative[0] == 1.0);
  CHECK(warnings.empty());
  CHECK_THAT(csv_error(one + "0,0\n30,0\n"),
             EndsWith("led.csv:3: expected light in some direction, found only zeros"));
}

TEST_CASE("What is wrong in a diagram's table is named with its line") {
  const std::string header =
      "led.csv:1: expected the columns angle_deg, relative or theta_deg, phi_deg, relative";
  CHECK_THAT(csv_error(""), EndsWith("led.csv:1: expected a header line"));
  CHECK_THAT(csv_error("angle_deg\n0\n"), EndsWith(header));
  CHECK_THAT(csv_error("phi_deg,relative\n0,1\n"), EndsWith(header));
  CHECK_THAT(csv_error("angle_deg,phi_deg,relative\n0,0,1\n"), EndsWith(header));
  CHECK_THAT(csv_error("angle_deg,relative,colour\n"),
             EndsWith("led.csv:1: unknown column \"colour\"; the columns are some of "
                      "angle_deg,theta_deg,phi_deg,relative"));
  CHECK_THAT(csv_error("angle_deg,relative,relative\n"),
             EndsWith("led.csv:1: column relative appears twice"));
  CHECK_THAT(csv_error(one), EndsWith("led.csv:2: expected at least two angles to the axis"));
  CHECK_THAT(csv_error(one + "0,1\n"), EndsWith("led.csv:3: expected at least two angles to the axis"));
  CHECK_THAT(csv_error(two + "0,0,1\n0,90,1\n"),
             EndsWith("led.csv:4: expected at least two angles to the axis"));
  CHECK_THAT(csv_error(one + "0,1\n10,0.5,3\n"), Contains("led.csv:3: expected 2 columns, found 3"));
  CHECK_THAT(csv_error(one + "0,1\n10\n"), EndsWith("led.csv:3: expected 2 columns, found 1"));
  CHECK_THAT(csv_error(one + "0,one\n"), EndsWith("led.csv:2:3: relative: expected a number, found \"one\""));
  CHECK_THAT(csv_error(one + "0,nan\n"), EndsWith("led.csv:2:3: relative: expected a number, found \"nan\""));
  CHECK_THAT(csv_error(one + "0,1\n10,-0.5\n"),
             EndsWith("led.csv:3:4: relative: expected a number from 0 to 1e+30, found \"-0.5\""));
  CHECK_THAT(csv_error(one + "0,1\n180.1,0\n"),
             EndsWith("led.csv:3:1: angle_deg: expected a number from 0 to 180, found \"180.1\""));
  CHECK_THAT(csv_error(one + "0,1\n20,1\n20,0\n"),
             EndsWith("led.csv:4: angle_deg: expected ascending angles, found 20 after 20"));
  CHECK_THAT(csv_error(one + "0,1\n20,1\n10,0\n"),
             EndsWith("led.csv:4: angle_deg: expected ascending angles, found 10 after 20"));
  CHECK_THAT(csv_error(two + "0,0,1\n-1,0,1\n"),
             Contains("led.csv:3:1: theta_deg: expected a number from 0 to 180"));
  CHECK_THAT(csv_error(two + "0,361,1\n"), Contains("led.csv:2:3: phi_deg: expected a number from 0 to 360"));
  CHECK_THAT(csv_error(two + "0,0,1\n0,90,1\n9,0,1\n9,90,1\n9,0,1\n"),
             EndsWith("led.csv:6: theta 9 with phi 0 appears twice"));
  CHECK_THAT(csv_error(two + "0,0,1\n0,90,1\n9,90,1\n"),
             EndsWith("led.csv:5: expected every theta with every phi, theta 9 with phi 0 is missing"));
  CHECK_THAT(csv_error(two + "0,0,1\n0,90,1\n9,0,1\n"), EndsWith("theta 9 with phi 90 is missing"));
  CHECK_THAT(
      csv_error(two + "0,0,1\n9,0,1\n9.0000001,0,1\n"),
      EndsWith(
          "led.csv:4: theta_deg: expected angles at least 1e-06 degrees apart, found 9.0000001 beside 9"));
  CHECK_THAT(csv_error(two + "0,0,1\n0,359.9999999,1\n9,0,1\n9,359.9999999,1\n"),
             EndsWith("led.csv:3: phi_deg: expected less than 360, or 360 itself"));
  CHECK_THAT(csv_error(one + "0,1\n1" + std::string(1, '\0') + ",1\n"),
             EndsWith("led.csv:3: expected text, found a NUL byte"));
}

TEST_CASE("A diagram's table has at most 2^20 directions") {
  std::string text = two;
  for (int theta = 0; theta < 1024; ++theta)
    for (int phi = 0; phi < 1024; ++phi)
      text += std::to_string(theta) + "e-1," + std::to_string(phi) + "e-1,1\n";
  CHECK(read_csv(text).relative.size() == std::size_t{1} << 20);
  CHECK_THAT(csv_error(text + "180,0,1\n"), EndsWith("led.csv:1048578: expected at most 1048576 directions"));
}
