#include "host/input/diagram/radiation_law.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/units.h"

#include <fmt/format.h>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;

namespace {

Diagram read_ies(const std::string &text, const char *name = "led.ies") {
  const test::TemporaryFolder folder;
  const auto file = folder.write(name, text);
  DiagramFiles files;
  const Diagram diagram = *files.read(file, Place{file});
  CHECK(files.warnings().empty());
  return diagram;
}

std::string ies_error(const std::string &text) {
  return test::input_error_of([&] { read_ies(text); });
}

// Vertical angles 0 and 90, 1 candela on the axis; `rim` lists the candela values at 90 degrees.
std::string with_horizontals(const std::vector<double> &horizontal_deg, const std::vector<double> &rim) {
  std::string text =
      fmt::format("IESNA:LM-63-2002\n[TEST] 1\nTILT=NONE\n1 1000 1 2 {} 1 2 0 0 0\n1 1 10\n0 90\n{}\n",
                  horizontal_deg.size(), fmt::join(horizontal_deg, " "));
  for (const double candela : rim)
    text += fmt::format("1 {}\n", candela);
  return text;
}

// J at 90 degrees to the axis, over phi in degrees.
std::map<int, double> rim_of(const Diagram &diagram) {
  std::map<int, double> rim;
  const std::size_t phis = diagram.phi_rad.size();
  REQUIRE(diagram.relative.size() == 2 * phis);
  for (std::size_t i = 0; i < phis; ++i) {
    CHECK(diagram.relative[i] == 1.0);
    rim[static_cast<int>(std::lround(diagram.phi_rad[i] / degree))] = diagram.relative[phis + i];
  }
  CHECK(std::ranges::is_sorted(diagram.phi_rad));
  return rim;
}

using Rim = std::map<int, double>;

const std::string label = "IESNA:LM-63-1995\n[TEST] 1\nTILT=NONE\n";
const std::string head = "1 1000 1 3 1 1 2 0 0 0 1 1 10\n";
const std::string good = label + head + "0 45 90\n0\n8 4 0\n"; // the last three are lines 5, 6 and 7

} // namespace

TEST_CASE("An IES file's nadir is the axis, its candela values are the shape") {
  const Diagram diagram = read_ies(good);
  CHECK(diagram.theta_rad == std::vector{0.0, std::numbers::pi / 4, std::numbers::pi / 2});
  CHECK(diagram.phi_rad == std::vector{0.0});
  CHECK(diagram.relative == std::vector{1.0, 0.5, 0.0});
}

TEST_CASE("An IES file may be of any edition, with its numbers on any lines") {
  const Diagram expected = read_ies(good);
  const auto check = [&](const std::string &text) {
    const Diagram diagram = read_ies(text);
    CHECK(diagram.theta_rad == expected.theta_rad);
    CHECK(diagram.relative == expected.relative);
  };
  const std::string numbers = head + "0 45 90\n0\n8 4 0\n";
  check("TILT=NONE\n" + numbers); // 1986, without a label
  check("A lamp by somebody\r\nof 3 lines, 1 2 3\r\n\r\nTILT=NONE\r\n1 1000 1 3 1 1 2 0 0 0\r\n1 1 10\r\n0 "
        "45 90\r\n"
        "0\r\n8 4 0\r\n");
  check("IESNA91\n[TEST] 1\n[MORE] TILT=INCLUDE is not here\nTILT=NONE\n" + numbers);
  check("IES:LM-63-2019\n[TEST] 1\n[TESTLAB] x\n[ISSUEDATE] y\n[MANUFAC] z\nTILT=NONE\n"
        "1 -1 1.0 3 1 1 2 0.1 -0.1 0\n1.0 1.00001 10\n0 45 90\n0\n8 4 0\n");
  check(label + "1\n1000 1,3\n1 , 1\t2 0 0\n0 1 1\n\n10 0\n45 90 0 8\n4\n0\n\n \n\x1a");
  check(label + "1 1000 250 3 1 1 2 0 0 0 2.5 1 10 0 45 90 0 2e1 +10 .0");
  check("IESNA91\nTILT=tilted.tlt\n" + numbers);
}

TEST_CASE("Tilt factors in an IES file are read past, however they are split") {
  const Diagram diagram =
      read_ies("IESNA91\nTILT=INCLUDE\n1\n3\n0 45\n90\n1.0 0.9 0.8\n" + head + "0 45 90\n0\n8 4 0\n");
  CHECK(diagram.relative == std::vector{1.0, 0.5, 0.0});
}

TEST_CASE("The ending .ies in any case makes an IES file, any other a table") {
  CHECK(read_ies(good, "LED.IES").relative.size() == 3);
  CHECK(read_ies("angle_deg,relative\n0,1\n9,1\n", "ies.txt").relative.size() == 2);
  CHECK_THAT(test::input_error_of([] { read_ies(good, "led.txt"); }),
             EndsWith("led.txt: is an IES diagram, expected IES (.ies) or a table of angles (CSV)"));
}

TEST_CASE("An IES file's symmetries are unfolded") {
  CHECK(rim_of(read_ies(with_horizontals({0}, {0.5}))) == Rim{{0, 0.5}});
  CHECK(rim_of(read_ies(with_horizontals({0, 30, 90}, {0, 0.3, 0.9}))) ==
        Rim{{0, 0}, {30, 0.3}, {90, 0.9}, {150, 0.3}, {180, 0}, {210, 0.3}, {270, 0.9}, {330, 0.3}});
  CHECK(rim_of(read_ies(with_horizontals({0, 30, 180}, {0, 0.3, 0.9}))) ==
        Rim{{0, 0}, {30, 0.3}, {180, 0.9}, {330, 0.3}});
}

TEST_CASE("An IES file's horizontal angles run against phi") {
  CHECK(rim_of(read_ies(with_horizontals({0, 90, 200, 360}, {0, 0.9, 0.2, 0}))) ==
        Rim{{0, 0}, {160, 0.2}, {270, 0.9}});
  // Bright at the horizontal angle 90, dark at 270, and 120 as bright as 60.
  CHECK(rim_of(read_ies(with_horizontals({90, 120, 180, 270}, {0.9, 0.6, 0.3, 0}))) ==
        Rim{{270, 0.9}, {240, 0.6}, {180, 0.3}, {90, 0}, {0, 0.3}, {300, 0.6}});
}

TEST_CASE("The horizontal angle 360 of an IES file is 0 again") {
  CHECK_THAT(
      ies_error(with_horizontals({0, 180, 360}, {0.5, 0, 0.6})),
      EndsWith("led.ies:10: expected at 360 degrees what 0 has, 0.5 (within 1 % of the maximum), found 0.6"));
}

TEST_CASE("What is wrong in an IES file is named with its line") {
  const auto with_head = [](const std::string &numbers) {
    return ies_error(label + numbers + "0 45 90\n0\n8 4 0\n");
  };
  const auto with_data = [](const std::string &numbers) { return ies_error(label + head + numbers); };
  const std::string no_tilt = "expected a line TILT=NONE, TILT=INCLUDE or TILT= and a file's name";
  CHECK_THAT(ies_error(""), EndsWith("led.ies:1: " + no_tilt));
  CHECK_THAT(ies_error("IESNA91\n[TEST] 1\n" + head), EndsWith("led.ies:3: " + no_tilt));
  CHECK_THAT(ies_error("IESNA91\nTILT= \n" + head),
             EndsWith("led.ies:2: expected NONE, INCLUDE or a file's name after TILT="));
  CHECK_THAT(ies_error("IESNA91\nTILT=INCLUDE\n4\n"),
             EndsWith("led.ies:3: lamp-to-luminaire geometry: expected a number from 1 to 3, found \"4\""));
  CHECK_THAT(ies_error("IESNA91\nTILT=INCLUDE\n1\n2 0 90\n1\none\n"),
             EndsWith("led.ies:6: tilt factor: expected a number, found \"one\""));
  CHECK_THAT(
      ies_error("IESNA91\nTILT=INCLUDE\n1\n1e9\n"),
      EndsWith("led.ies:4: number of tilt angles: expected a number from 1 to 1048576, found \"1e9\""));
  CHECK_THAT(ies_error(label),
             EndsWith("led.ies:4: number of lamps: expected a number, found the end of the file"));
  CHECK_THAT(with_head("one 1000 1 3 1 1 2 0 0 0 1 1 10\n"),
             EndsWith("led.ies:4: number of lamps: expected a number, found \"one\""));
  CHECK_THAT(with_head("1 1000 0 3 1 1 2 0 0 0 1 1 10\n"),
             EndsWith("led.ies:4: candela multiplier: expected a number above 0"));
  CHECK_THAT(
      with_head("1 1000 1\n0 1 1 2 0 0 0 1 1 10\n"),
      EndsWith("led.ies:5: number of vertical angles: expected a number from 2 to 1048576, found \"0\""));
  CHECK_THAT(with_head("1 1000 1 2.5 1 1 2 0 0 0 1 1 10\n"),
             EndsWith("led.ies:4: number of vertical angles: expected a whole number, found 2.5"));
  CHECK_THAT(with_head("1 1000 1 3 0 1 2 0 0 0 1 1 10\n"),
             Contains("led.ies:4: number of horizontal angles: expected a number from 1"));
  CHECK_THAT(with_head("1 1000 1 3 1e300 1 2 0 0 0 1 1 10\n"),
             Contains("led.ies:4: number of horizontal angles: expected a number from 1"));
  CHECK_THAT(with_head("1 1000 1 1025 1024 1 2 0 0 0 1 1 10\n"),
             EndsWith("led.ies:4: expected at most 1048576 candela values, found 1025 vertical times 1024 "
                      "horizontal angles"));
  CHECK_THAT(with_head("1 1000 1 3 1 2 2 0 0 0 1 1 10\n"),
             EndsWith("led.ies:4: photometric type: expected 1 (type C), found 2, type B"));
  CHECK_THAT(with_head("1 1000 1 3 1 3 2 0 0 0 1 1 10\n"),
             EndsWith("led.ies:4: photometric type: expected 1 (type C), found 3, type A"));
  CHECK_THAT(with_head("1 1000 1 3 1 0 2 0 0 0 1 1 10\n"),
             Contains("led.ies:4: photometric type: expected a number from 1 to 3"));
  CHECK_THAT(with_head("1 1000 1 3 1 1 2 0 0 0 1 1 1e999\n"),
             EndsWith("led.ies:4: input watts: expected a number, found \"1e999\""));
  CHECK_THAT(with_data("0 90 45\n0\n8 4 0\n"),
             EndsWith("led.ies:5: vertical angle: expected ascending angles, found 45 after 90"));
  CHECK_THAT(with_data("0 90 181\n0\n8 4 0\n"),
             EndsWith("led.ies:5: vertical angle: expected a number from 0 to 180, found \"181\""));
  CHECK_THAT(with_data("-90 0 90\n0\n8 4 0\n"),
             EndsWith("led.ies:5: vertical angle: expected a number from 0 to 180, found \"-90\""));
  CHECK_THAT(with_data("0 45 90\n0\n8 -4 0\n"),
             EndsWith("led.ies:7: candela value: expected a number from 0 to 1e+30, found \"-4\""));
  CHECK_THAT(with_data("0 45 90\n0\n8 4 inf\n"),
             EndsWith("led.ies:7: candela value: expected a number, found \"inf\""));
  CHECK_THAT(with_data("0 45 90\n0\n8 4\n"),
             EndsWith("led.ies:8: candela value: expected a number, found the end of the file"));
  CHECK_THAT(with_data("0 45 90\n0\n8 4 0\n7\n"),
             EndsWith("led.ies:8: expected the end of the file after the last candela value, found \"7\""));
  CHECK_THAT(with_data("0 45 90\n0\n0 0 0\n"),
             EndsWith("led.ies:7: expected light in some direction, found only zeros"));
  CHECK_THAT(ies_error(good + std::string(1, '\0')), EndsWith("led.ies:8: expected text, found a NUL byte"));
  const std::string spans =
      "horizontal angles: expected a single 0, or 0 to 90, 180 or 360, or 90 to 270, found ";
  CHECK_THAT(with_data("0 45 90\n5\n8 4 0\n"), EndsWith("led.ies:6: " + spans + "5 to 5"));
  CHECK_THAT(ies_error(with_horizontals({0, 45}, {1, 1})), EndsWith("led.ies:7: " + spans + "0 to 45"));
  CHECK_THAT(ies_error(with_horizontals({90, 180}, {1, 1})), EndsWith(spans + "90 to 180"));
  CHECK_THAT(ies_error(with_horizontals({0, 180, 90}, {1, 1, 1})),
             EndsWith("led.ies:7: horizontal angle: expected ascending angles, found 90 after 180"));
}
