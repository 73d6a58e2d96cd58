// `pmdsim correct` of images as cameras and their software leave them, without a scene.

#include "tests/program/refusal.h"
#include "tests/whole/command_line/run_fixture.h"
#include "tests/whole/correct/corrections.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

constexpr int side = 16; // so that one pixel of all is a stray one
constexpr double ambiguity_m = 299792458.0 / 2 / 20e6;

// The distance of a wall, by its depth, at a pixel of the small setup's sensor.
double wall_m(int row, int column, double depth_m = 2.0) {
  constexpr double pitch_over_f = 45e-6 / 0.0018;
  const double x = (column - 7.5) * pitch_over_f, y = (row - 7.5) * pitch_over_f;
  return depth_m * std::sqrt(1 + x * x + y * y);
}

// Rows of what `cell` says of each pixel.
std::string rows_of(const std::function<std::string(int row, int column)> &cell) {
  std::string text;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      text += cell(row, column) + (column + 1 < side ? "," : "\n");
  return text;
}

std::string wall_rows(double depth_m = 2.0, double unit_m = 1.0) {
  return rows_of(
      [=](int row, int column) { return fmt::format("{}", wall_m(row, column, depth_m) / unit_m); });
}

// Millimetres as NumPy has unsigned integers of 16 bit.
std::string npy_mm(const std::function<std::uint16_t(int row, int column)> &value) {
  std::string header = "{'descr': '<u2', 'fortran_order': False, 'shape': (16, 16), }\n";
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  bytes += header;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const std::uint16_t number = value(row, column);
      bytes += static_cast<char>(number & 0xffu);
      bytes += static_cast<char>(number >> 8u);
    }
  return bytes;
}

// A setup without a scene.
class RealCamera : public Corrections {
public:
  explicit RealCamera(const std::function<void(json &setup)> &change = [](json &) {}) {
    json of_camera = json::parse(small_setup());
    of_camera.erase("scene");
    of_camera["sensors"][0]["resolution"] = {side, side};
    change(of_camera);
    setup = work.write("setup.json", of_camera.dump());
  }

  Run correct_text(const std::string &rows, const std::vector<std::string> &more = {}) const {
    return correct(work.write("image.csv", rows), more);
  }
  json corrected_text(const std::string &rows, const std::vector<std::string> &more = {}) const {
    return corrected(work.write("image.csv", rows), more);
  }
};

std::vector<std::string> codes_of(const json &told) {
  std::vector<std::string> codes;
  for (const json &warning : told.at("warnings"))
    codes.push_back(warning.at("code"));
  return codes;
}

int count_of(const std::string &text, const std::string &part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

} // namespace

TEST_CASE("a setup without a scene serves, but for the truth and for nodes", "[smoke]") {
  const RealCamera camera;
  const json told = camera.corrected_text(wall_rows());
  CHECK(told.at("pixels").at("corrected").get<int>() + told.at("pixels").at("edge").get<int>() ==
        side * side);
  CHECK(told.at("warnings").empty());
  CHECK(told.at("values").at("quantity") == "distance");
  CHECK(told.at("values").at("median").get<double>() == Approx(2.0).epsilon(0.02));
  check_refusal(camera.correct_text(wall_rows(), {"--truth", "scene"}), 2,
                {"--truth scene", "has no \"scene\"", "expected an image of ranges"});
  check_refusal(run_pmdsim({"check", camera.setup}), 3, {"missing key \"scene\""});
  const RealCamera at_node([](json &setup) { setup["sensors"][0]["pose"] = {{"node", "Camera"}}; });
  check_refusal(at_node.correct_text(wall_rows()), 3,
                {"/sensors/0/pose/node", "the setup has no \"scene\"", "\"Camera\""});
  const RealCamera with_nodes([](json &setup) {
    setup["nodes"] = {{"table", {{"pose", {{"position_m", {0, 0, 0}}, {"quaternion_xyzw", {0, 0, 0, 1}}}}}}};
  });
  check_refusal(with_nodes.correct_text(wall_rows()), 3, {"/nodes", "the setup has no scene"});
}

TEST_CASE("a scene that no one asks for is not read") {
  const RealCamera camera([](json &setup) { setup["scene"] = "none.gltf"; });
  CHECK(camera.corrected_text(wall_rows()).at("warnings").empty());
  check_refusal(camera.correct_text(wall_rows(), {"--truth", "scene"}), 3,
                {"/scene", "none.gltf", "no such file"});
}

TEST_CASE("numbers that say: not measured") {
  const RealCamera camera;
  const auto without_first = [](const std::string &mark) {
    return rows_of([=](int row, int column) {
      return row == 0 && column < 3 ? mark : fmt::format("{}", wall_m(row, column));
    });
  };
  for (const char *mark : {"0", "-1", "nan", "inf", ""}) {
    INFO(mark);
    CHECK(camera.corrected_text(without_first(mark)).at("pixels").at("not_measured") == 3);
  }
  CHECK(camera.corrected_text(without_first("7")).at("pixels").at("not_measured") == 0);
  CHECK(camera.corrected_text(without_first("7"), {"--invalid", "7"}).at("pixels").at("not_measured") == 3);
  CHECK(camera.corrected_text(without_first("-1"), {"--quantity", "phase"}).at("pixels").at("not_measured") ==
        0);
  CHECK(camera.corrected_text(without_first("0"), {"--quantity", "phase"}).at("pixels").at("not_measured") ==
        0);
  for (const std::uint16_t mark : {std::uint16_t{0}, std::uint16_t{65535}}) {
    const std::string image =
        camera.work.write("image.npy", npy_mm([=](int row, int column) {
                            return row == 0 && column < 3
                                       ? mark
                                       : static_cast<std::uint16_t>(std::lround(1e3 * wall_m(row, column)));
                          }));
    const json told = camera.corrected(image);
    CHECK(told.at("pixels").at("not_measured") == 3);
    CHECK(told.at("turns").is_null());
    CHECK(told.at("noise_um").get<double>() >= 1e3 / std::sqrt(12.0));
  }
}

TEST_CASE("what tells the turn: an option before the image, and no stray pixel") {
  const RealCamera camera;
  const auto far_wall = [](double first_m) {
    return rows_of([=](int row, int column) {
      return row + column == 0 ? fmt::format("{}", first_m)
                               : fmt::format("{}", wall_m(row, column, 9.5) - ambiguity_m);
    });
  };
  const auto median_m = [&](const std::string &rows, const std::vector<std::string> &more) {
    std::vector<std::string> options{"--truth", camera.work.write("true.csv", wall_rows(9.5))};
    options.insert(options.end(), more.begin(), more.end());
    return 1e-6 * camera.corrected_text(rows, options)
                      .at("errors")
                      .at(0)
                      .at("corrected_um")
                      .at("median")
                      .get<double>();
  };
  for (const double stray_m : {7.6, 70.0, -1.0, 0.0})
    CHECK(median_m(far_wall(stray_m), {"--least-range", "5m"}) < 0.1);
  const json of_one = camera.corrected_text(far_wall(7.6));
  CHECK(of_one.at("turns").is_null());
  CHECK(of_one.at("stray_distances") == 1);
  CHECK(camera.corrected_text(wall_rows(9.5)).at("turns").get<std::string>().find("100.0 %") !=
        std::string::npos);
  CHECK(median_m(wall_rows(9.5), {}) < 0.1);
  CHECK(median_m(wall_rows(9.5), {"--least-range", "0"}) > 7.0);

  const std::string rounded = camera.work.write(
      "image.npy", npy_mm([](int row, int column) {
        return static_cast<std::uint16_t>(std::lround(1e3 * (row < 4 ? ambiguity_m : wall_m(row, column))));
      }));
  REQUIRE(std::round(1e3 * ambiguity_m) > 1e3 * ambiguity_m);
  CHECK(camera.corrected(rounded).at("turns").is_null());
  CHECK(camera.corrected(rounded).at("stray_distances") == 0);
}

TEST_CASE("a turn that is wrong everywhere is told with its remedy") {
  const RealCamera camera;
  const std::string truth = camera.work.write("true.csv", wall_rows(9.5));
  const std::string folded =
      rows_of([](int row, int column) { return fmt::format("{}", wall_m(row, column, 9.5) - ambiguity_m); });
  const Run run = camera.correct_text(folded, {"--truth", truth});
  CHECK(run.output.find("256 pixels are off by about whole ambiguity ranges of 7.495 m: --least-range") !=
        std::string::npos);
  CHECK(
      camera.correct_text(folded, {"--truth", truth, "--least-range", "5m"}).output.find("whole ambiguity") ==
      std::string::npos);
}

TEST_CASE("another unit and another quantity do not pass without a word") {
  const RealCamera camera;
  using Codes = std::vector<std::string>;
  CHECK(codes_of(camera.corrected_text(wall_rows())).empty());
  CHECK(codes_of(camera.corrected_text(wall_rows(2.0, 1e-3))) == Codes{"image-unit"});
  CHECK(codes_of(camera.corrected_text(wall_rows(2.0, 1e-3), {"--unit", "mm"})).empty());
  CHECK(camera.corrected_text(wall_rows(2.0, 1e-4), {"--unit", "0.1mm"})
            .at("values")
            .at("median")
            .get<double>() == Approx(2.0).epsilon(0.02));
  const std::string turn = rows_of(
      [](int row, int column) { return fmt::format("{}", 6.283185 * (row * side + column + 0.1) / 255.2); });
  CHECK(codes_of(camera.corrected_text(turn)) == Codes{"image-is-phase"});
  CHECK(codes_of(camera.corrected_text(turn, {"--quantity", "phase"})).empty());
  const Run run = camera.correct_text(wall_rows(2.0, 1e-3));
  CHECK(run.errors.find("millimetres? --unit mm [image-unit]") != std::string::npos);
  CHECK(run.output.find("distance in metres: min 2") != std::string::npos);
  check_refusal(camera.correct_text(wall_rows(), {"--unit", "cm"}), 2, {"--unit", "0.1mm", "found \"cm\""});
  check_refusal(camera.correct_text(wall_rows(), {"--quantity", "range"}), 2,
                {"--quantity: expected distance, phase or depth, found \"range\"", "--truth"});
  check_refusal(camera.correct_text(wall_rows(), {"--quantity", "dept"}), 2, {"did you mean \"depth\"?"});
  check_refusal(camera.correct_text(wall_rows(), {"--guess", "9.5m"}), 2,
                {"--guess: expected an image", "--least-range takes a length"});
}

TEST_CASE("the cloud and the profile of a corrected image") {
  const RealCamera camera;
  REQUIRE(camera.correct_text(wall_rows(), {"--format", "ply,csv"}).exit_code == 0);
  const std::string cloud = bytes_in(camera.work / "corrected/pmd_0000.ply");
  for (const char *property : {"float normal_error_mm", "float correction_mm", "uint status"})
    CHECK(cloud.find(fmt::format("property {}\n", property)) != std::string::npos);
  CHECK(cloud.find("along each pixel's ray, corrected\n") != std::string::npos);
  const std::string profile = bytes_in(camera.work / "corrected/pmd_0000.profile.csv");
  const std::string header = "," + profile.substr(0, profile.find('\n')) + ",";
  CHECK(header.starts_with(",column,chip_x_m,angle_deg,range_m,x_m,"));
  CHECK(count_of(header, ",x_m,") == 1);
}

TEST_CASE("a corrected image has a manifest and a page, and takes no other run's place") {
  const RealCamera camera;
  const std::string image = camera.work.write("image.csv", wall_rows());
  REQUIRE(camera.correct(image, {"--format", "exr"}).exit_code == 0);
  const json manifest = json::parse(bytes_in(camera.work / "corrected/manifest.json"));
  CHECK(manifest.at("command") == "correct");
  CHECK(manifest.at("correction").at("image") == image);
  CHECK(manifest.at("frames").at(0).at("outputs") == json{"pmd_0000.exr"});
  CHECK(std::ranges::any_of(manifest.at("inputs"),
                            [](const json &input) { return input.at("file") == "image.csv"; }));
  const Run report = run_pmdsim({"report", camera.work / "corrected"});
  INFO(report.errors);
  CHECK(report.exit_code == 0);
  CHECK(bytes_in(camera.work / "corrected/report.html").find("corrected range") != std::string::npos);
  REQUIRE(camera.correct(image, {"--format", "exr"}).exit_code == 0); // again
  camera.work.write("corrected/manifest.json", R"({"command": "render", "frames": []})");
  check_refusal(camera.correct(image), 7, {"has the frames of `pmdsim render`", "another directory"});
  camera.work.write("corrected/manifest.json", R"({"command": 5})"); // is no run's
  CHECK(camera.correct(image, {"--format", "exr"}).exit_code == 0);
}

TEST_CASE("a link in a run's directory is no image") {
  const RealCamera camera;
  std::filesystem::create_directory(camera.work / "run");
  std::filesystem::create_symlink("/etc/passwd", camera.work / "run/pmd_0000.h5");
  check_refusal(camera.correct(camera.work / "run"), 3, {"pmd_0000.h5: is a link, expected a file"});
}
