// Point clouds as files, read by the test's own reader.

#include "engine/model/scene.h"
#include "host/output/clouds/cloud_picture.h"
#include "host/output/clouds/ply_writer.h"
#include "tests/host/output/directory_content.h"
#include "tests/host/output/nan_value.h"
#include "tests/host/output/pixel_of.h"
#include "tests/support/ply_file.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr glm::uvec2 resolution(7, 5);
constexpr std::size_t pixels = 7 * 5;

// A frame of random distances of a camera that stands somewhere and looks somewhere.
struct RandomFrame {
  Sensor sensor;
  std::vector<float> distance_m, range_m, amplitude;
  std::vector<std::uint32_t> object_id;
  std::vector<glm::vec3> normals;
  ChannelSet channels{resolution, {}};

  RandomFrame() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> metres(1.0f, 6.0f);
    sensor.name = "pmd";
    sensor.resolution = resolution;
    sensor.pixel_pitch_m = {45e-6, 30e-6};
    sensor.focal_length_m = 2e-4;
    sensor.world_from_camera.rotation =
        glm::dmat3(glm::rotate(glm::dmat4(1.0), 1.1, glm::normalize(glm::dvec3(1.0, -2.0, 0.5))));
    sensor.world_from_camera.translation_m = {10.0, -3.0, 0.25};
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      distance_m.push_back(metres(random));
      range_m.push_back(distance_m.back() - 0.01f);
      amplitude.push_back(0.1f * static_cast<float>(pixel));
      object_id.push_back(static_cast<std::uint32_t>(pixel % 3));
      normals.emplace_back(0.0f, 0.6f, -0.8f);
    }
    for (const std::size_t gap : {std::size_t{0}, std::size_t{17}, pixels - 1})
      distance_m[gap] = nan_value;
    object_id[2] = no_id;
    channels.channels = {{"amplitude", "W/(m² sr)", std::span<const float>(amplitude)},
                         {"distance_m", "m", std::span<const float>(distance_m)},
                         {"range_m", "m", std::span<const float>(range_m)},
                         {"object_id", "", std::span<const std::uint32_t>(object_id)}};
  }

  // Where a pixel's point lies by the formula of a pinhole.
  glm::dvec3 point_m(std::size_t pixel, float at_m) const {
    const double x = (static_cast<double>(pixel % 7) + 0.5 - 3.5) * 45e-6 / 2e-4;
    const double y = (static_cast<double>(pixel / 7) + 0.5 - 2.5) * 30e-6 / 2e-4;
    return sensor.world_from_camera.rotation *
               (static_cast<double>(at_m) * glm::normalize(glm::dvec3(x, y, 1.0))) +
           sensor.world_from_camera.translation_m;
  }

  std::string file(bool with_normals = true) const {
    const TemporaryFolder temporary;
    OutputFile file(temporary.path() / "cloud.ply");
    write_ply(file, {sensor, channels}, with_normals ? std::span(normals) : std::span<const glm::vec3>(),
              {sensor, 3, 0.5});
    file.close();
    file.publish();
    return content_of(file.path());
  }
};

Canvas picture_of(const RandomFrame &frame) {
  const PointCloud cloud(frame.sensor, frame.channels);
  return CloudPicture(cloud).draw("title");
}

} // namespace

TEST_CASE("a point cloud has the measured point of every pixel that has a distance") {
  const RandomFrame frame;
  const PlyFile ply = parsed_ply(frame.file());
  REQUIRE(ply.vertices == pixels - 3);
  CHECK(ply.properties == std::vector<std::string>{"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue",
                                                   "amplitude", "distance_m", "range_m", "object_id", "row",
                                                   "column"});
  std::size_t vertex = 0;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    if (std::isnan(frame.distance_m[pixel]))
      continue;
    CHECK(ply["row"][vertex] == static_cast<double>(pixel / 7));
    CHECK(ply["column"][vertex] == static_cast<double>(pixel % 7));
    const glm::dvec3 expected = frame.point_m(pixel, frame.distance_m[pixel]);
    const glm::dvec3 found(ply["x"][vertex], ply["y"][vertex], ply["z"][vertex]);
    CHECK(glm::length(found - expected) < 2e-6); // float32 at 16 m
    CHECK(ply["distance_m"][vertex] == static_cast<double>(frame.distance_m[pixel]));
    CHECK(ply["range_m"][vertex] == static_cast<double>(frame.range_m[pixel]));
    CHECK(ply["amplitude"][vertex] == static_cast<double>(frame.amplitude[pixel]));
    CHECK(ply["object_id"][vertex] == static_cast<double>(frame.object_id[pixel]));
    CHECK(ply["ny"][vertex] == static_cast<double>(0.6f));
    ++vertex;
  }
}

TEST_CASE("comments of a point cloud tell of its frame, whatever the sensor's name holds") {
  RandomFrame frame;
  frame.sensor.name = "a\nelement vertex 99\n\"b";
  const PlyFile ply = parsed_ply(frame.file());
  CHECK(ply.vertices == pixels - 3);
  CHECK(ply.comments.at(1) == R"(sensor "a\nelement vertex 99\n\"b", frame 3, 0.5 s)");
  CHECK(ply.comments.at(2).find("world frame") != std::string::npos);
  CHECK(ply.comments.at(3).find(" 0.25") != std::string::npos);
}

TEST_CASE("what a frame has not its point cloud has not") {
  RandomFrame frame;
  frame.channels.channels.erase(frame.channels.channels.begin());
  frame.channels.channels.pop_back();
  const PlyFile ply = parsed_ply(frame.file(false));
  CHECK(ply.properties == std::vector<std::string>{"x", "y", "z", "red", "green", "blue", "distance_m",
                                                   "range_m", "row", "column"});
  CHECK(ply["red"] == std::vector<double>(pixels - 3, 140.0)); // grey
  frame.channels.channels.clear();
  CHECK_THROWS_AS(PointCloud(frame.sensor, frame.channels), std::logic_error);
}

TEST_CASE("of several frequencies unwrapped distances become points") {
  RandomFrame frame;
  std::vector<float> unwrapped(pixels, 20.0f);
  frame.channels.channels[1].frequency = 0;
  frame.channels.channels.push_back({"unwrapped_distance_m", "m", std::span<const float>(unwrapped)});
  const PlyFile ply = parsed_ply(frame.file());
  REQUIRE(ply.vertices == pixels);
  const glm::dvec3 expected = frame.point_m(17, 20.0f);
  CHECK(ply["x"][17] == Approx(expected.x));
  CHECK(ply["unwrapped_distance_m"][17] == 20.0);
  CHECK(ply.columns.count("distance_m") == 0);
}

TEST_CASE("colours of points grow with amplitude, from the ends of viridis") {
  const RandomFrame frame;
  const PlyFile ply = parsed_ply(frame.file());
  CHECK(ply["green"].back() > 200.0);
  CHECK(ply["green"][0] < 60.0);
  CHECK(std::is_sorted(ply["green"].begin(), ply["green"].end()));
}

TEST_CASE("a picture of a point cloud shows its points in their colours") {
  RandomFrame frame;
  frame.amplitude.assign(pixels, 1.0f);
  Canvas canvas = picture_of(frame);
  const auto yellow = [](std::uint32_t pixel) { return pixel == 0xfde725; };
  CHECK(count_pixels(canvas, yellow) > 500);
  frame.distance_m.assign(pixels, nan_value);
  Canvas empty = picture_of(frame);
  CHECK(count_pixels(empty, yellow) == 0);
  frame.distance_m[3] = 1e-30f; // in the lens
  CHECK(picture_of(frame).width() == canvas.width());
}

TEST_CASE("the nearer of two points hides the other in a picture") {
  RandomFrame frame;
  frame.sensor.resolution = frame.channels.resolution = {400, 300};
  frame.sensor.pixel_pitch_m = {1e-6, 1e-6};
  const std::size_t many = 400 * 300;
  // A plate of twice the amplitude before a wall of the same extent in angle covers a part of it.
  frame.distance_m.assign(many, 3.0f);
  frame.amplitude.assign(many, 0.25f);
  for (std::size_t row = 100; row < 200; ++row)
    for (std::size_t column = 150; column < 250; ++column) {
      frame.distance_m[row * 400 + column] = 2.0f;
      frame.amplitude[row * 400 + column] = 1.0f;
    }
  frame.channels.channels = {{"amplitude", "W/(m² sr)", std::span<const float>(frame.amplitude)},
                             {"distance_m", "m", std::span<const float>(frame.distance_m)}};
  Canvas canvas = picture_of(frame);
  const int plate = count_pixels(canvas, [](std::uint32_t pixel) { return pixel == 0xfde725; });
  CHECK(plate > 2000);
  std::reverse(frame.distance_m.begin(), frame.distance_m.end());
  std::reverse(frame.amplitude.begin(), frame.amplitude.end());
  Canvas turned = picture_of(frame);
  CHECK(count_pixels(turned, [](std::uint32_t pixel) { return pixel == 0xfde725; }) == plate);
}
