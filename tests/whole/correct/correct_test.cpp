// `pmdsim correct` as people call it.

#include "tests/program/refusal.h"
#include "tests/whole/command_line/run_fixture.h"
#include "tests/whole/correct/corrections.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

// A rendered frame of the small wall.
class Rendered : public Corrections {
public:
  explicit Rendered(const std::string &formats = "exr,npy,npz,h5") {
    work.write("wall.gltf", wall_gltf());
    setup = work.write("setup.json", small_setup());
    const Run run =
        run_pmdsim({"render", setup, "--device", "reference", "--format", formats, "-o", work / "frame"});
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
  }
};

constexpr double promised_um = 2.0;

double largest_um(const json &told, const char *of = "interior") {
  for (const json &row : told.at("errors"))
    if (row.at("of") == of)
      return row.at("corrected_um").at("max");
  FAIL("no row of that name");
  return 0.0;
}

} // namespace

TEST_CASE("a rendered frame comes back, from its directory and from each format", "[smoke]") {
  const Rendered frame;
  for (const char *name : {"frame", "frame/pmd_0000.exr", "frame/pmd_0000.npz", "frame/pmd_0000.h5"}) {
    INFO(name);
    const json told = frame.corrected(frame.work / name);
    CHECK(told.at("pixels").at("corrected") == 64);
    CHECK(largest_um(told) < promised_um);
    CHECK(told.at("errors").at(0).at("measured_um").at("max") > 1000.0);
    CHECK(told.at("correction_mm").at("median") > 2.0);
  }
  const json of_npy = frame.corrected(frame.work / "frame/pmd_0000.distance_m.npy", {"--truth", "scene"});
  CHECK(largest_um(of_npy) < promised_um);
  const json of_phase = frame.corrected(frame.work / "frame/pmd_0000.phase_rad.npy",
                                        {"--truth", frame.work / "frame/pmd_0000.range_m.npy"});
  CHECK(largest_um(of_phase) < promised_um);
  const json of_channel = frame.corrected(frame.work / "frame", {"--channel", "phase_rad"});
  CHECK(largest_um(of_channel) < promised_um);
}

TEST_CASE("what is written and said") {
  const Rendered frame;
  const Run run = frame.correct(frame.work / "frame", {"--format", "npy,ply,png,csv"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  CHECK(run.output.find("corrected  64 of 64 pixels") != std::string::npos);
  CHECK(run.output.find("interior, corrected") != std::string::npos);
  CHECK(frame.work.files("corrected") ==
        std::vector<std::string>{"manifest.json", "pmd_0000.cloud.png", "pmd_0000.correction_mm.npy",
                                 "pmd_0000.correction_mm.png", "pmd_0000.normal_error_mm.npy", "pmd_0000.ply",
                                 "pmd_0000.profile.csv", "pmd_0000.range_m.npy", "pmd_0000.range_m.png",
                                 "pmd_0000.status.npy", "pmd_0000.x_m.npy", "pmd_0000.y_m.npy",
                                 "pmd_0000.z_m.npy"});
}

TEST_CASE("units, quantities and rows of numbers") {
  const Rendered frame;
  std::string metres, millimetres, turns, depths;
  constexpr double wall_m = 2.0, pitch_over_f = 45e-6 / 0.0018;
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 8; ++column) {
      const char *end = column < 7 ? "," : "\n";
      const double x = (column - 3.5) * pitch_over_f, y = (row - 3.5) * pitch_over_f;
      const double d = wall_m * std::sqrt(1 + x * x + y * y);
      metres += fmt::format("{}{}", d, end);
      millimetres += fmt::format("{}{}", 1e3 * d, end);
      turns += fmt::format("{}{}", d / (299792458.0 / 2 / 20e6), end);
      depths += fmt::format("{}{}", wall_m, end);
    }
  const auto median = [&](const std::string &text, const std::vector<std::string> &more) {
    return double(
        frame.corrected(frame.work.write("image.csv", text), more).at("correction_mm").at("median"));
  };
  const double expected = median(metres, {});
  CHECK(expected > 1.0);
  CHECK(median(millimetres, {"--unit", "mm"}) == Approx(expected));
  CHECK(median(turns, {"--unit", "turns"}) == Approx(expected));
  CHECK(median(depths, {"--quantity", "depth"}) == Approx(expected));
}

TEST_CASE("images that do not fit, and options that cannot be") {
  const Rendered frame("exr");
  const std::string image = frame.work / "frame/pmd_0000.exr";
  check_refusal(frame.correct(frame.work / "none.npy"), 3, {"none.npy"});
  check_refusal(frame.correct(frame.work.write("a.csv", "1,2\n3,4\n")), 3,
                {"a.csv", "expected 8 x 8 pixels (columns x rows) as sensor \"pmd\" has, found 2 x 2"});
  check_refusal(frame.correct(image, {"--channel", "nothing"}), 3, {"pmd_0000.exr", "nothing", "distance_m"});
  check_refusal(frame.correct(image, {"--frequency", "1"}), 2, {"--frequency 1", "less than 1"});
  check_refusal(frame.correct(image, {"--frame", "3"}), 2, {"--frame 3"});
  check_refusal(frame.correct(image, {"--sensor", "x"}), 2, {"--sensor x", "pmd"});
  check_refusal(frame.correct(image, {"--quantity", "phase", "--unit", "mm"}), 2,
                {"--unit mm", "rad or turns"});
  check_refusal(frame.correct(image, {"--normals", "0"}), 2, {"--normals", "1 to 16"});
  check_refusal(frame.correct(image, {"--least-range", "far"}), 2, {"--least-range", "7.5m"});
  check_refusal(frame.correct(image, {"--unwrap", "20m"}), 2, {"--unwrap", "two frequencies"});
  check_refusal(frame.correct(frame.work / "."), 3, {"expected one of", "pmd_0000.exr"});
  check_refusal(frame.correct(frame.work / "frame/manifest.json"), 3,
                {"manifest.json:1:1: expected a number"});
  CHECK(frame.work.files("corrected").empty());
}

TEST_CASE("a step of two frequencies is unwrapped") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup =
      work.write("setup.json", with(with(small_setup(), "[20e6]", "[80e6, 100e6]"),
                                    "\"focal_length_m\": 0.0018", "\"focal_length_m\": 0.0036"));
  REQUIRE(run_pmdsim({"render", setup, "--device", "reference", "--format", "npz", "-o", work / "frame"})
              .exit_code == 0);
  const auto told = [&](const std::vector<std::string> &more) {
    std::vector<std::string> arguments{"correct", setup, work / "frame", "-o", work / "corrected", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Run run = run_pmdsim(arguments);
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
    return json::parse(run.output);
  };
  const auto largest = [&](const std::vector<std::string> &more) { return largest_um(told(more)); };
  CHECK(told({}).at("wrong_turns") == 64); // at the wrong turn the wall is no plane, and has no interior
  CHECK(told({"--unwrap", "7m"}).at("wrong_turns") == 0);
  CHECK(largest({"--unwrap", "7m"}) < promised_um);
  CHECK(largest({"--unwrap", "7m", "--frequency", "1"}) < promised_um);
  CHECK(largest({"--least-range", "1.9m"}) < promised_um);
}

TEST_CASE("every shipped scene of direct light comes back within 2 micrometres", "[long]") {
  fmt::print("{:<18}{:>9}{:>14}{:>14}{:>9}\n", "scene", "pixels", "measured, um", "corrected, um", "edges");
  for (const char *name :
       {"paper_ring", "paper_half_ring", "paper_moire", "closed_box", "room", "signal", "penumbra"}) {
    const Workspace work;
    const Run render =
        run_pmdsim({"render", scene(std::string(name) + ".json"), "--format", "npz", "-o", work / "frame"});
    INFO(name << ": " << render.errors);
    REQUIRE(render.exit_code == 0);
    const Run run = run_pmdsim({"correct", scene(std::string(name) + ".json"), work / "frame", "--format",
                                "npz", "-o", work / "corrected", "--json"});
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
    const json told = json::parse(run.output), row = told.at("errors").at(0);
    CHECK(row.at("of") == "interior");
    fmt::print("{:<18}{:>9}{:>14.4g}{:>14.4g}{:>9}\n", name, row.at("pixels").get<int>(),
               row.at("measured_um").at("max").get<double>(), row.at("corrected_um").at("max").get<double>(),
               told.at("pixels").at("edge").get<int>());
    CHECK(largest_um(told) <= promised_um);
  }
}
