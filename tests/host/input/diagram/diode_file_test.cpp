#include "host/input/diagram/diode_file.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/support/temporary_folder.h"

#include <cmath>

using namespace pmdsim;
using Catch::Contains;
using Catch::EndsWith;

namespace {

const std::string header = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n";

std::vector<Diode> read_diodes(const std::string &text) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("diodes.csv", text);
  DiagramFiles diagrams;
  return read_diode_file(file, Place{file}, diagrams);
}

std::string diodes_error(const std::string &text) {
  return test::input_error_of([&] { read_diodes(text); });
}

} // namespace

TEST_CASE("A diode file gives position, unit axis, intensity and pattern") {
  const auto diodes = read_diodes(header + "0.1,-0.2,3e-3,0,3,4,2.5,3.5\n1,2,3,0,0,1e-200,0,isotropic\n");
  REQUIRE(diodes.size() == 2);
  CHECK(diodes[0].position_m == glm::dvec3(0.1, -0.2, 3e-3));
  CHECK(glm::length(diodes[0].axis - glm::dvec3(0, 0.6, 0.8)) < 1e-15);
  CHECK(diodes[0].intensity_w_sr == 2.5);
  CHECK(diodes[0].pattern.kind == Pattern::Kind::cosine);
  CHECK(diodes[0].pattern.order == 3.5);
  CHECK(diodes[1].axis == glm::dvec3(0, 0, 1));
  CHECK(diodes[1].pattern.kind == Pattern::Kind::isotropic);
}

TEST_CASE("A law may be named by its key and its number") {
  const auto diodes = read_diodes(header + "0,0,0,0,0,1,1,order 2.5\n");
  CHECK(diodes[0].pattern.kind == Pattern::Kind::cosine);
  CHECK(diodes[0].pattern.order == 2.5);
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1,order -1\n"),
             EndsWith(":2: pattern: expected a number from 0 to 1000000, found \"-1\""));
  for (const std::string file : {"order", "isotropic 1", "file"})
    CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1," + file + "\n"),
               Contains("found \"" + file + "\": no such file"));
}

TEST_CASE("Columns come in any order, lines end in any way") {
  const auto diodes = read_diodes("pattern, z_m,y_m,x_m,intensity_w_sr,axis_z,axis_y,axis_x\r\nisotropic, 3 "
                                  ",2,1,4,1,0,0\r\n1,3,2,1,4,1,0,0");
  REQUIRE(diodes.size() == 2);
  CHECK(diodes[0].position_m == glm::dvec3(1, 2, 3));
  CHECK(diodes[1].pattern.order == 1.0);
}

TEST_CASE("What is wrong in a diode file is named with its line") {
  CHECK_THAT(diodes_error("x_m,y_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n"),
             EndsWith("diodes.csv:1: missing column z_m"));
  CHECK_THAT(diodes_error("colour," + header), Contains("diodes.csv:1: unknown column \"colour\""));
  CHECK_THAT(
      diodes_error("No,x_mm,y_m,z_m,nx,dir_y,axis_z,intensity,pattern\n"),
      EndsWith("diodes.csv:1: unknown columns \"No\"; \"x_mm\", expected \"x_m\", in metres; \"nx\", did you "
               "mean \"axis_x\"?; \"dir_y\", did you mean \"axis_y\"?; \"intensity\", did you mean "
               "\"intensity_w_sr\", in watts per steradian?; the columns are "
               "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern and perhaps roll_deg"));
  CHECK_THAT(diodes_error("x_m," + header), EndsWith("diodes.csv:1: column x_m appears twice"));
  CHECK_THAT(diodes_error(""), EndsWith("diodes.csv:1: expected a header line"));
  CHECK_THAT(diodes_error(header), EndsWith("diodes.csv:2: expected at least one diode"));
  const std::string good = "0,0,0,0,0,1,1,isotropic\n";
  CHECK_THAT(diodes_error(header + good + "0,zero,0,0,0,1,1,2\n"),
             EndsWith("diodes.csv:3:3: y_m: expected a number, found \"zero\""));
  CHECK_THAT(diodes_error(header + "1.5x,0,0,0,0,1,1,2\n"),
             EndsWith(":2:1: x_m: expected a number, found \"1.5x\""));
  CHECK_THAT(diodes_error(header + "0,0,,0,0,1,1,2\n"), EndsWith(":2:5: z_m: expected a number, found \"\""));
  CHECK_THAT(diodes_error(header + "0,0,nan,0,0,1,1,2\n"),
             EndsWith(":2:5: z_m: expected a number, found \"nan\""));
  CHECK_THAT(diodes_error(header + "0,0,1e999,0,0,1,1,2\n"), Contains("z_m: expected a number"));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,0,1,2\n"),
             EndsWith(":2:7: expected an axis, as 0, 0, 1 is, found zero"));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,-1,2\n"),
             EndsWith(":2:13: intensity_w_sr: expected a number from 0 to 1e+30, found \"-1\""));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1,-2\n"),
             EndsWith(":2: pattern: expected a number from 0 to 1000000, found \"-2\""));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1,1e\n"),
             EndsWith(":2: pattern: expected a number, found \"1e\""));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1,\n"),
             EndsWith(":2: pattern: expected an order such as 1, isotropic, or a diagram's file name"));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1,inf\n"),
             EndsWith(":2: pattern: expected an order such as 1, isotropic, or a diagram's file name, found "
                      "\"inf\": no such file"));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1,Lambertian\n"),
             EndsWith("found \"Lambertian\": no such file; Lambert's law is the order 1"));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1,isotrop\n"),
             EndsWith("found \"isotrop\": no such file, did you mean \"isotropic\"?"));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1\n"), EndsWith(":2: expected 8 columns, found 7"));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1,1,1\n"), Contains(":2: expected 8 columns, found 9"));
  CHECK_THAT(diodes_error(header + "\n"), EndsWith(":3: expected at least one diode"));
}

TEST_CASE("A table's diagrams lie in its folder or below") {
  for (const std::string file : {"/etc/passwd", "../led.csv", "below/../../led.csv"})
    CHECK_THAT(
        diodes_error(header + "0,0,0,0,0,1,1," + file + "\n"),
        EndsWith("diodes.csv:2: pattern: \"" + file +
                 "\" lies outside the table's folder, expected a file there; a setup's \"pattern\" may "
                 "name others"));
  CHECK_THAT(diodes_error(header + "0,0,0,0,0,1,1," + std::string(300, 'x') + "\n"),
             EndsWith(": File name too long"));
}

TEST_CASE("Blank lines are skipped and counted") {
  const std::string good = "0,0,0,0,0,1,1,isotropic\n";
  CHECK(read_diodes("\n" + header + "\n" + good + " \t\n\r\n" + good + "\n\n").size() == 2);
  CHECK(read_diodes(header + good + "  ").size() == 1);
  CHECK_THAT(diodes_error(header + "\n\r\n" + good + "\nzero,0,0,0,0,1,1,2\n"),
             EndsWith("diodes.csv:6:1: x_m: expected a number, found \"zero\""));
  CHECK_THAT(
      diodes_error("\n\nx_m\n"),
      EndsWith("diodes.csv:3: missing columns y_m, z_m, axis_x, axis_y, axis_z, intensity_w_sr, pattern"));
}

TEST_CASE("A number may have a plus sign") {
  const auto diodes = read_diodes(header + "+3,+.5,+1e-2,0,0,+1,+2,+3\n");
  REQUIRE(diodes.size() == 1);
  CHECK(diodes[0].position_m == glm::dvec3(3, 0.5, 0.01));
  CHECK(diodes[0].intensity_w_sr == 2.0);
  CHECK(diodes[0].pattern.order == 3.0);
  CHECK_THAT(diodes_error(header + "+-3,0,0,0,0,1,1,2\n"), EndsWith("x_m: expected a number, found \"+-3\""));
  CHECK_THAT(diodes_error(header + "++3,0,0,0,0,1,1,2\n"), EndsWith("x_m: expected a number, found \"++3\""));
  CHECK_THAT(diodes_error(header + "+,0,0,0,0,1,1,2\n"), EndsWith("x_m: expected a number, found \"+\""));
}

TEST_CASE("A NUL byte is refused") {
  const std::string good = "0,0,0,0,0,1,1,isotropic\n";
  const auto with_nul = [&](std::string text) {
    return header + good + text.replace(text.find('#'), 1, 1, '\0');
  };
  CHECK_THAT(diodes_error(with_nul("1#2,0,0,0,0,1,1,2\n")),
             EndsWith("diodes.csv:3: expected text, found a NUL byte"));
  CHECK_THAT(diodes_error(with_nul("1,0,0,0,0,1,1,2\n#")),
             EndsWith("diodes.csv:4: expected text, found a NUL byte"));
}

TEST_CASE("A diode file has at most 100,000 diodes") {
  std::string text = header;
  for (int i = 0; i < 100'000; ++i)
    text += "0,0,0,0,0,1,1,1\n";
  CHECK(read_diodes(text).size() == 100'000);
  CHECK_THAT(diodes_error(text + "0,0,0,0,0,1,1,1\n"), EndsWith(":100002: expected at most 100000 diodes"));
}
