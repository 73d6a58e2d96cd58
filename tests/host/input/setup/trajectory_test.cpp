// Poses over time from files, and what moves along them.

#include "host/input/setup/trajectory.h"
#include "tests/host/input/setup/setup_fixture.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace pmdsim;
using test::SetupFixture;
using test::TemporaryFolder;

namespace {

Trajectory read(const std::string &text) {
  const TemporaryFolder folder;
  return read_trajectory(folder.write("poses", text), Place{"setup.json"});
}

std::string why_not(const std::string &text) {
  const std::string message = test::input_error_of([&] { read(text); });
  return message.substr(message.find("poses") + 5);
}

constexpr const char *tum = "# timestamp tx ty tz qx qy qz qw\n"
                            "1.0 0 0 0  0 0 0 1\n"
                            "\n"
                            "3.0 2 0 -4  0 0.70710678 0 0.70710678\r\n";

} // namespace

TEST_CASE("TUM's form: poses at, between, before and after its lines") {
  const Trajectory trajectory = read(tum);
  REQUIRE(trajectory.times_s == std::vector<double>{1.0, 3.0});
  const Pose between = trajectory.at(2.0);
  CHECK(between.translation_m == glm::dvec3(1, 0, -2));
  const glm::dvec3 z = between.direction({0, 0, 1}); // turned by 45 degrees about y
  CHECK(z.x == Approx(std::numbers::sqrt2 / 2));
  CHECK(z.z == Approx(std::numbers::sqrt2 / 2));
  CHECK(trajectory.at(-5.0) == trajectory.at(1.0));
  CHECK(trajectory.at(9.0).translation_m == glm::dvec3(2, 0, -4));
  CHECK(glm::length(trajectory.at(3.0).direction({0, 0, 1}) - glm::dvec3(1, 0, 0)) < 1e-8);
}

TEST_CASE("CSV, its columns in any order, and ROS's") {
  const Trajectory ours = read("qw,qx,qy,qz,x_m,y_m,z_m,time_s,note\n1,0,0,0,5,6,7,0.25,first\n");
  CHECK(ours.at(0.25).translation_m == glm::dvec3(5, 6, 7));
  CHECK(ours.times_s.front() == 0.25);
  const Trajectory ros =
      read("%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.position.x,"
           "field.pose.position.y,field.pose.position.z,field.pose.orientation.x,"
           "field.pose.orientation.y,field.pose.orientation.z,field.pose.orientation.w\n"
           "1500000000,1,1500000000,map,1,2,3,0,0,0,1\n");
  CHECK(ros.times_s.front() == 1.5);
  CHECK(ros.at(0.0).translation_m == glm::dvec3(1, 2, 3));
}

TEST_CASE("KITTI's poses, a second from one to the next, and EuRoC's") {
  const Trajectory kitti = read("1 0 0 1.5 0 1 0 2.5 0 0 1 3.5\n0 -1 0 1 1 0 0 2 0 0 1 3\n");
  CHECK(kitti.times_s == std::vector<double>{0.0, 1.0});
  CHECK(kitti.at(0.0).translation_m == glm::dvec3(1.5, 2.5, 3.5));
  CHECK(glm::distance(kitti.at(1.0).direction({1, 0, 0}), glm::dvec3(0, 1, 0)) < 1e-12);
  const Trajectory euroc = read("#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
                                "q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1]\n"
                                "1500000000,1,2,3,0,1,0,0,9\n");
  CHECK(euroc.times_s == std::vector<double>{1.5});
  CHECK(euroc.at(0.0).translation_m == glm::dvec3(1, 2, 3));
  CHECK(euroc.at(0.0).direction({0, 0, 1}) == glm::dvec3(0, 0, -1)); // half a turn about x
  CHECK(why_not("1 0 0 0 0 2 0 0 0 0 1 0\n") == ":1: expected three rows of a rotation and a translation, "
                                                "found a matrix that scales, shears or mirrors");
  CHECK(why_not("#timestamp, p_RS_R_x [m]\n1,2\n") == ":1: missing column p_RS_R_y");
}

TEST_CASE("Files that are no trajectories") {
  CHECK(why_not("# nothing\n") == ": expected at least one pose");
  CHECK(why_not("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n") == ":2: expected a time after 1 s, found 1 s");
  CHECK(why_not("1 0 0 0 0 0 0 2\n") == ":1: expected a quaternion of length 1, found 2");
  CHECK(why_not("1 0 0 0 0 0 0\n") == ":1: expected 8 values, found 7");
  CHECK(why_not("1 0 0 x 0 0 0 1\n").find(":1:7: z_m: expected a number") == 0);
  CHECK(why_not("1 2e9 0 0 0 0 0 1\n").find(":1:3: x_m: expected a number from") == 0);
  CHECK(why_not("time_s,x_m\n1,2\n") == ":1: missing column y_m");
  CHECK(why_not("time_s,x_m,y_m,z_m,qx,qy,qz,qw\n1,2\n") == ":2: expected 8 values, found 2");
}

TEST_CASE("A sensor moves along a trajectory, and frames are taken at its poses") {
  SetupFixture fixture;
  fixture.folder.write("poses.tum", tum);
  fixture.sensor()["pose"] = {{"trajectory", "poses.tum"}};
  fixture.setup["frames"] = {{"trajectory", "poses.tum"}};
  const Setup setup = fixture.load();
  REQUIRE(setup.frames.count == 2);
  CHECK(setup.frames.time_s(1) == 3.0);
  REQUIRE(setup.motion);
  const Instant at = setup.at(setup.frames.time_s(1));
  CHECK(at.sensors[0].world_from_camera.translation_m == glm::dvec3(2, 0, -4));
  CHECK(at.illuminators[0].world_from_illuminator.translation_m == glm::dvec3(2, 0, -4)); // at the sensor
  CHECK(setup.as_used["frames"]["count"] == 2);
  fixture.setup["frames"]["count"] = 3;
  CHECK(fixture.error().find("/frames/count: expected 2") != std::string::npos);
  fixture.setup["frames"] = {{"trajectory", "poses.tum"}, {"rate_hz", 2}};
  CHECK(fixture.error().find("/frames: expected no start_s and no rate_hz beside a trajectory") !=
        std::string::npos);
}

TEST_CASE("A node is put elsewhere with its children, and keeps its scale") {
  SetupFixture fixture;
  fixture.scene["nodes"] = nlohmann::json::parse(
      R"([{"name": "arm", "scale": [2, 2, 2], "children": [1]}, {"name": "hand", "translation": [0, 0, 1], "mesh": 0}])");
  fixture.scene["scenes"][0]["nodes"] = {0};
  const std::vector<glm::dvec3> before = fixture.load().start.scene.positions_m;
  fixture.setup["nodes"]["arm"]["pose"]["matrix"] = {
      {0, 0, 1, 10}, {0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 0, 1}};
  const std::vector<glm::dvec3> after = fixture.load().start.scene.positions_m;
  REQUIRE(before.size() == after.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    CHECK(test::distance(after[i], glm::dvec3(10 + before[i].z, before[i].y, -before[i].x)) < 1e-9);
}

TEST_CASE("A node that is mirrored or sheared is not put elsewhere") {
  SetupFixture fixture;
  const nlohmann::json at_origin{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  fixture.setup["nodes"]["arm"]["pose"]["matrix"] = at_origin;
  fixture.scene["scenes"][0]["nodes"] = {0};
  const auto error_with = [&](const char *node) {
    fixture.scene["nodes"] = nlohmann::json::array({nlohmann::json::parse(node)});
    return fixture.error();
  };
  CHECK(error_with(R"({"name": "arm", "scale": [-1, 1, 1], "mesh": 0})")
            .find("/nodes/arm: the node is mirrored") != std::string::npos);
  CHECK(error_with(R"({"name": "arm", "mesh": 0, "matrix": [1,0,0,0, 0.5,1,0,0, 0,0,1,0, 0,0,0,1]})")
            .find("/nodes/arm: the node is sheared") != std::string::npos);
}

TEST_CASE("Matrices that do not turn and move alone") {
  SetupFixture fixture;
  const auto error_of = [&](const nlohmann::json &matrix) {
    fixture.sensor()["pose"] = {{"matrix", matrix}};
    return fixture.error();
  };
  CHECK(error_of({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 1, 1}})
            .find("/matrix/3: expected the last row") != std::string::npos);
  for (const nlohmann::json &matrix :
       {nlohmann::json{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 1}},
        nlohmann::json{{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}},
        nlohmann::json{{1, 0.1, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}},
        nlohmann::json{{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 1}}})
    CHECK(error_of(matrix).find("/matrix: expected a rotation and a translation") != std::string::npos);
  CHECK(error_of({{1, 0, 0}, {0, 1, 0}}).find("/sensors/0/pose/matrix") != std::string::npos);
}
