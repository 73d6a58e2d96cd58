// --output-precision: distances as they were before they were rounded.

#include "tests/program/program.h"
#include "tests/program/refusal.h"
#include "tests/whole/command_line/run_fixture.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

using namespace pmdsim::test;

namespace {

// A ring of 10 mm before a wall at 2 m, of several frequencies.
class SmallRing {
public:
  SmallRing() {
    space.write("wall.gltf", wall_gltf());
    nlohmann::json json = nlohmann::json::parse(small_setup());
    json["sensors"][0]["modulation_hz"] = {20e6, 60e6};
    json["sensors"][0]["unwrap_range_m"] = 5.0;
    json["illuminators"][0]["diodes"] = {{"rings", {{{"radius_m", 0.01}, {"count", 48}}}}};
    setup_ = space.write("setup.json", json.dump());
  }

  Run run(const std::string &command, const std::string &out, const std::vector<std::string> &options) const {
    std::vector<std::string> arguments{command, setup_, "-o", space / out};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_pmdsim(arguments);
  }
  Run run_well(const std::string &command, const std::string &out,
               const std::vector<std::string> &options) const {
    Run ended = run(command, out, options);
    INFO(ended.errors);
    REQUIRE(ended.exit_code == 0);
    return ended;
  }
  std::string npy(const std::string &out, const std::string &channel) const {
    return bytes_in(space / (out + "/pmd_0000." + channel + ".npy"));
  }
  // The values of such a file.
  template <class Value>
  std::vector<Value> values(const std::string &out, const std::string &channel,
                            const std::string &type) const {
    const std::string bytes = npy(out, channel);
    INFO(out << ", " << channel);
    REQUIRE(bytes.find("'descr': '" + type + "'") != std::string::npos);
    const std::size_t begin = bytes.find('\n') + 1;
    std::vector<Value> read((bytes.size() - begin) / sizeof(Value));
    std::memcpy(read.data(), bytes.data() + begin, read.size() * sizeof(Value));
    return read;
  }

  Workspace space;

private:
  std::string setup_;
};

const std::vector<std::string> in_double{"--format", "npy", "--output-precision", "float64"};

bool is_in_double(const std::string &channel) {
  return channel.ends_with("distance_m") || channel == "range_m";
}

} // namespace

TEST_CASE("distances are written in double where that is asked for, and all other files stay the same") {
  const SmallRing ring;
  ring.run_well("render", "single", {"--format", "npy", "--output-precision", "float32"});
  ring.run_well("render", "usual", {"--format", "npy"});
  ring.run_well("render", "double", in_double);
  CHECK(ring.space.files("double") == ring.space.files("single"));
  std::size_t doubles = 0;
  for (const std::string &file : ring.space.files("single")) {
    if (!file.ends_with(".npy"))
      continue;
    const std::string channel = file.substr(9, file.size() - 13);
    INFO(channel);
    CHECK(ring.npy("usual", channel) == ring.npy("single", channel));
    if (!is_in_double(channel)) {
      CHECK(ring.npy("double", channel) == ring.npy("single", channel));
      continue;
    }
    ++doubles;
    const auto rounded = ring.values<float>("single", channel, "<f4");
    const auto unrounded = ring.values<double>("double", channel, "<f8");
    REQUIRE(unrounded.size() == rounded.size());
    for (std::size_t i = 0; i < rounded.size(); ++i)
      CHECK(std::abs(unrounded[i] - static_cast<double>(rounded[i])) <= 3e-7);
  }
  CHECK(doubles == 4); // of two frequencies, unwrapped, and the range
}

TEST_CASE("a deformation keeps its digits, and is the difference of distances in double") {
  const SmallRing ring;
  const std::vector<std::string> of_distance{"--precision", "fp64", "--channels",
                                             "distance_m,deformation_mm"};
  std::vector<std::string> options = in_double;
  options.insert(options.end(), of_distance.begin(), of_distance.end());
  ring.run_well("deform", "double", options);
  const Run single = ring.run_well("deform", "single", {"--json", "--precision", "fp64", "--format", "npy"});
  const auto deformation = ring.values<double>("double", "f0.deformation_mm", "<f8");
  const auto rounded = ring.values<float>("single", "f0.deformation_mm", "<f4");
  ring.values<float>("single", "f0.distance_m", "<f4");
  ring.values<double>("double", "f0.distance_m", "<f8");
  const Run exact = ring.run_well("deform", "exact", {"--json", "--device", "reference", "--format", "npy"});
  const auto centre_mm = [](const Run &run) -> double {
    return nlohmann::json::parse(run.output).at("deformation_mm").at("centre");
  };
  CHECK(centre_mm(single) == Approx(500.0 * (std::hypot(2.0, 0.01) - 2.0)).epsilon(2e-3)); // beside the axis
  CHECK(centre_mm(single) == Approx(centre_mm(exact)).epsilon(1e-7));
  REQUIRE(rounded.size() == deformation.size());
  for (std::size_t i = 0; i < rounded.size(); ++i)
    CHECK((std::isnan(deformation[i]) ? std::isnan(rounded[i])
                                      : rounded[i] == static_cast<float>(deformation[i])));
}

TEST_CASE("the precision of distances belongs to the run, and asks for a file that has them") {
  const SmallRing ring;
  ring.run_well("render", "out", in_double);
  check_refusal(ring.run("render", "out", {"--format", "npy", "--resume"}), 3,
                {"output_precision", "float64"});
  ring.run_well("render", "out", {"--format", "npy", "--resume", "--output-precision", "float64"});
  check_refusal(ring.run("render", "bad", {"--output-precision", "double"}), 2,
                {"--output-precision", "float64"});
  check_refusal(ring.run("render", "bad", {"--output-precision", "float64", "--format", "png"}), 2,
                {"--output-precision float64", "expected one of them among --format"});
  CHECK(!std::filesystem::exists(ring.space / "bad"));
}
