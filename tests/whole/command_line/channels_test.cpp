// --channels and the formats of whole frames.

#include "tests/program/program.h"
#include "tests/program/refusal.h"
#include "tests/whole/command_line/run_fixture.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

using namespace pmdsim::test;

namespace {

nlohmann::json manifest_in(const std::string &directory) {
  std::ifstream stream(directory + "/manifest.json");
  return nlohmann::json::parse(stream);
}

void require_success(const Run &run) {
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
}

class WallSetup {
public:
  WallSetup() : setup_(space.write("setup.json", small_setup())) { space.write("wall.gltf", wall_gltf()); }

  Run run(const std::string &command, const std::string &out, const std::vector<std::string> &options) const {
    std::vector<std::string> arguments{command, setup_, "-o", space / out};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_pmdsim(arguments);
  }

  Workspace space;

private:
  std::string setup_;
};

} // namespace

TEST_CASE("render writes only the channels that are asked for, with the bytes that they have among all") {
  const WallSetup wall;
  require_success(wall.run("render", "all", {"--format", "npy"}));
  const std::vector<std::string> options{"--format", "npy,png,csv", "--channels", "z_m,distance_m"};
  require_success(wall.run("render", "some", options));
  CHECK(wall.space.files("some") ==
        std::vector<std::string>{"0000.record.json", "manifest.json", "pmd_0000.cloud.png",
                                 "pmd_0000.distance_m.npy", "pmd_0000.distance_m.png", "pmd_0000.profile.csv",
                                 "pmd_0000.z_m.npy", "run.json"});
  for (const std::string name : {"z_m", "distance_m"})
    CHECK(bytes_in(wall.space / ("some/pmd_0000." + name + ".npy")) ==
          bytes_in(wall.space / ("all/pmd_0000." + name + ".npy")));
  CHECK(bytes_in(wall.space / "some/pmd_0000.profile.csv")
            .starts_with("column,chip_x_m,angle_deg,distance_m,z_m\n"));
  CHECK(manifest_in(wall.space / "all").at("channels").is_null());
  CHECK(manifest_in(wall.space / "some").at("channels") == nlohmann::json{"distance_m", "z_m"});
  CHECK(manifest_in(wall.space / "some").at("setup") == manifest_in(wall.space / "all").at("setup"));
}

TEST_CASE("the text of a frame tells of the channels that it has") {
  const WallSetup wall;
  const Run truth = wall.run("render", "truth", {"--channels", "coverage,object_id"});
  require_success(truth);
  CHECK(truth.output.find("100.00 % of the samples hit") != std::string::npos);
  CHECK(truth.output.find("median") == std::string::npos);
  const Run distance = wall.run("render", "distance", {"--channels", "distance_m"});
  CHECK(distance.output.find("\ndistance ") != std::string::npos);
  CHECK(distance.output.find("\namplitude ") == std::string::npos);
  CHECK(distance.output.find("samples hit") == std::string::npos);
}

TEST_CASE("deform writes the deformation alone, or beside channels that are asked for") {
  const WallSetup wall;
  require_success(wall.run("deform", "all", {"--format", "npy"}));
  const Run alone = wall.run("deform", "alone", {"--channels", "deformation_mm", "--format", "npy,png"});
  require_success(alone);
  CHECK(wall.space.files("alone") ==
        std::vector<std::string>{"0000.record.json", "manifest.json", "pmd_0000.deformation_mm.npy",
                                 "pmd_0000.deformation_mm.png", "pmd_0000.deformation_profile.png",
                                 "run.json"});
  CHECK(bytes_in(wall.space / "alone/pmd_0000.deformation_mm.npy") ==
        bytes_in(wall.space / "all/pmd_0000.deformation_mm.npy"));
  const Run other = wall.run("deform", "other", {"--channels", "range_m", "--format", "npy,png"});
  require_success(other);
  CHECK(wall.space.files("other") ==
        std::vector<std::string>{"0000.record.json", "manifest.json", "pmd_0000.range_m.npy", "run.json"});
  CHECK(other.output.find("deformation (bistatic") != std::string::npos);
}

TEST_CASE("channels that there are not are refused, and nothing is written") {
  const WallSetup wall;
  check_refusal(wall.run("render", "out", {"--channels", "distance"}), 2,
                {"--channels: unknown channel \"distance\", did you mean \"distance_m\"?"});
  check_refusal(wall.run("render", "out", {"--channels", "z_m,deformation_mm"}), 2,
                {"unknown channel \"deformation_mm\""});
  check_refusal(wall.run("deform", "out", {"--channels", "nothing"}), 2, {"expected of deformation_mm, "});
  check_refusal(wall.run("render", "out", {"--channels", "z_m,f1.distance_m"}), 2,
                {"setup.json has \"f1.distance_m\""});
  check_refusal(wall.run("render", "out", {"--channels", "unwrap_ok"}), 2, {"setup.json has \"unwrap_ok\""});
  check_refusal(wall.run("render", "out", {"--channels", "range_m", "--format", "png"}), 2,
                {"--format png: no picture is made of any of --channels"});
  CHECK(!std::filesystem::exists(wall.space / "out"));
}

TEST_CASE("normals and rays are written where they are asked for, alone or beside all others") {
  const WallSetup wall;
  require_success(wall.run("render", "usual", {"--format", "npy"}));
  require_success(wall.run("render", "view", {"--format", "npy", "--channels", "normals,ray_z"}));
  require_success(wall.run("render", "more", {"--format", "npy,h5,exr,csv", "--channels", "all,rays"}));
  CHECK(wall.space.files("view") == std::vector<std::string>{"0000.record.json", "manifest.json",
                                                             "pmd_0000.normal_x.npy", "pmd_0000.normal_y.npy",
                                                             "pmd_0000.normal_z.npy", "pmd_0000.ray_z.npy",
                                                             "run.json"});
  CHECK(bytes_in(wall.space / "view/pmd_0000.ray_z.npy") == bytes_in(wall.space / "more/pmd_0000.ray_z.npy"));
  CHECK(manifest_in(wall.space / "more").at("channels") == nlohmann::json{"all", "rays"});
  const std::vector<std::string> usual = wall.space.files("usual"), more = wall.space.files("more");
  CHECK(more.size() == usual.size() + 6); // three channels, and three files of all
  CHECK(std::ranges::includes(more, usual));
  CHECK(std::ranges::none_of(usual, [](const std::string &name) { return name.find("ray_") != name.npos; }));
}

TEST_CASE("the same channels in another order are the same run") {
  const WallSetup wall;
  require_success(wall.run("render", "out", {"--channels", "z_m,distance_m"}));
  require_success(wall.run("render", "out", {"--resume", "--channels", "distance_m,z_m,z_m"}));
}

TEST_CASE("whole frames become NumPy's archives and HDF5 files, the same at every run") {
  const WallSetup wall;
  for (const std::string out : {"one", "other"})
    require_success(wall.run("render", out, {"--format", "npz,h5"}));
  CHECK(wall.space.files("one") == std::vector<std::string>{"0000.record.json", "manifest.json",
                                                            "pmd_0000.h5", "pmd_0000.npz", "run.json"});
  for (const std::string name : {"pmd_0000.npz", "pmd_0000.h5"})
    CHECK(bytes_in(wall.space / ("one/" + name)) == bytes_in(wall.space / ("other/" + name)));
  CHECK(bytes_in(wall.space / "one/pmd_0000.npz").starts_with("PK"));
  CHECK(bytes_in(wall.space / "one/pmd_0000.h5").starts_with("\x89HDF"));
  check_refusal(wall.run("render", "bad", {"--format", "hdf5"}), 2, {"--format", "npz", "h5"});
}
