// A calibrated camera becomes a sensor that images as OpenCV's projectPoints does, and that a setup takes.

#include "engine/lens/lens.h"
#include "host/input/calibration/calibration_sensor.h"
#include "tests/host/input/setup/setup_fixture.h"

#include <array>
#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

// Pixels that OpenCV's documentation of calib3d gives to a point (x, y, 1) before the camera, written out.
glm::dvec2 tilted(const Calibration &c, const glm::dvec2 &slope) {
  const double sx = std::sin(c.tau_x_rad), cx = std::cos(c.tau_x_rad);
  const double sy = std::sin(c.tau_y_rad), cy = std::cos(c.tau_y_rad);
  // R(tauX, tauY) = [[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]] [[1, 0, 0], [0, cx, sx], [0, -sx, cx]], row by
  // row.
  const std::array<glm::dvec3, 3> r{glm::dvec3(cy, sy * sx, -sy * cx), glm::dvec3(0.0, cx, sx),
                                    glm::dvec3(sy, -cy * sx, cy * cx)};
  const glm::dvec3 q(slope, 1.0);
  const glm::dvec3 p(glm::dot(r[0], q), glm::dot(r[1], q), glm::dot(r[2], q));
  // [[R33, 0, -R13], [0, R33, -R23], [0, 0, 1]] p, over its third component.
  return {(r[2].z * p.x - r[0].z * p.z) / p.z, (r[2].z * p.y - r[1].z * p.z) / p.z};
}

glm::dvec2 projected(const Calibration &c, double x, double y) {
  glm::dvec2 slope(x, y);
  const double r = std::hypot(x, y), r2 = r * r;
  if (const auto *d = std::get_if<BrownConrady>(&c.distortion)) {
    const double radial = 1.0 + d->k1 * r2 + d->k2 * r2 * r2 + d->k3 * r2 * r2 * r2;
    slope = {x * radial + 2.0 * d->p1 * x * y + d->p2 * (r2 + 2.0 * x * x),
             y * radial + d->p1 * (r2 + 2.0 * y * y) + 2.0 * d->p2 * x * y};
  } else if (const auto *f = std::get_if<Fisheye>(&c.distortion)) {
    const double theta = std::atan(r), t2 = theta * theta;
    const double theta_d =
        theta * (1.0 + f->k1 * t2 + f->k2 * t2 * t2 + f->k3 * std::pow(t2, 3) + f->k4 * std::pow(t2, 4));
    slope = r > 0.0 ? slope * (theta_d / r) : slope;
  }
  const glm::dvec2 on_chip = tilted(c, slope);
  return {c.fx * on_chip.x + c.cx, c.fy * on_chip.y + c.cy};
}

Calibration calibration() {
  Calibration c;
  c.resolution = {640, 480};
  c.fx = 612.5, c.fy = 598.25;
  c.cx = 331.75, c.cy = 226.5;
  return c;
}

// The sensor places a net of points over the image where OpenCV does. OpenCV counts pixels from the centre of
// the first, Lens from its corner.
void check_against_opencv(const Calibration &c, const Sensor &sensor) {
  const Lens lens(sensor);
  for (int i = -8; i <= 8; ++i)
    for (int k = -8; k <= 8; ++k) {
      const double x = 0.055 * i, y = 0.04 * k;
      const auto chip_m = lens.chip_m({2.0 * x, 2.0 * y, 2.0});
      REQUIRE(chip_m);
      const glm::dvec2 pixel = lens.pixel(*chip_m) - 0.5, expected = projected(c, x, y);
      INFO(x << " " << y << ": " << pixel.x << " " << pixel.y);
      CHECK(glm::distance(pixel, expected) < 1e-6);
    }
}

// The block, printed and loaded by a setup.
Sensor loaded(const Sensor &sensor) {
  SetupFixture fixture;
  fixture.setup["sensors"] = {json::parse(sensor_block(sensor).dump(2))};
  return fixture.load().start.sensors.at(0);
}

void check_calibration(const Calibration &c) {
  for (const double pitch_m : {10e-6, 45e-6}) {
    const Sensor sensor = sensor_of(c, pitch_m);
    check_against_opencv(c, sensor);
    check_against_opencv(c, loaded(sensor));
  }
}

std::string error_of(const Calibration &c, double pitch_m = default_pixel_pitch_m) {
  return input_error_of([&] { sensor_of(c, pitch_m); });
}

std::string name_of(const std::string &name) {
  Calibration c = calibration();
  c.name = name;
  return sensor_of(c, default_pixel_pitch_m).name;
}

} // namespace

TEST_CASE("A point on the optical axis lands on the principal point") {
  const Lens lens(sensor_of(calibration(), 10e-6));
  const glm::dvec2 pixel = lens.pixel(*lens.chip_m({0, 0, 1})) - 0.5;
  CHECK(pixel.x == Approx(331.75).margin(1e-9));
  CHECK(pixel.y == Approx(226.5).margin(1e-9));
}

TEST_CASE("A pinhole in the image's centre needs neither distortion nor chip pose") {
  Calibration c = calibration();
  c.cx = 319.5, c.cy = 239.5;
  const Sensor sensor = sensor_of(c, 10e-6);
  CHECK(sensor.focal_length_m == 612.5 * 10e-6);
  CHECK(sensor.pixel_pitch_m == glm::dvec2(10e-6, 612.5 * 10e-6 / 598.25));
  CHECK(sensor.chip.is_nominal());
  const auto block = sensor_block(sensor);
  CHECK_FALSE(block.contains("distortion"));
  CHECK_FALSE(block.contains("chip"));
  CHECK(block["modulation_hz"] == json({20e6}));
  check_calibration(c);
}

TEST_CASE("A pinhole with its principal point elsewhere images as OpenCV's") {
  check_calibration(calibration());
}

TEST_CASE("Brown-Conrady images as OpenCV's") {
  Calibration c = calibration();
  c.distortion = BrownConrady{-0.21, 0.08, 1.5e-3, -2.5e-3, -0.01};
  check_calibration(c);
}

TEST_CASE("The fisheye images as OpenCV's") {
  Calibration c = calibration();
  c.distortion = Fisheye{-0.02, 0.011, -0.004, 0.0005};
  check_calibration(c);
}

TEST_CASE("OpenCV's tilted sensor is a chip pose") {
  Calibration c = calibration();
  c.tau_x_rad = 0.11;
  check_calibration(c);
  c.tau_x_rad = 0.0;
  c.tau_y_rad = -0.17;
  check_calibration(c);
  c.tau_x_rad = 0.11;
  c.distortion = BrownConrady{-0.21, 0.08, 1.5e-3, -2.5e-3, -0.01};
  check_calibration(c);
  const Sensor sensor = sensor_of(c, 10e-6);
  CHECK(sensor.chip.rotation_rad == glm::dvec3(0.11, -0.17, 0.0));
}

TEST_CASE("A chip that is tilted about the image's centre only turns") {
  Calibration c = calibration();
  c.cx = 319.5, c.cy = 239.5;
  c.tau_x_rad = 0.2;
  CHECK(sensor_of(c, 10e-6).chip.translation_m == glm::dvec3(0.0));
  check_calibration(c);
}

TEST_CASE("The sensor's name is the file's, as a setup takes it") {
  CHECK(name_of("") == "camera");
  CHECK(name_of("pmd_2.left-B") == "pmd_2.left-B");
  CHECK(name_of("narrow_stereo/left") == "narrow_stereo_left");
  CHECK(name_of("/__left eye") == "left_eye");
  CHECK(name_of("../..") == "camera");
  CHECK(name_of("\xc3\xa9") == "camera");
  CHECK(name_of(std::string(100, 'a')) == std::string(64, 'a'));
  for (const char *name : {"a", "A.b-c_9", "0"})
    CHECK(is_sensor_name(name));
  for (const char *name : {"", ".a", "_a", "a b", "a/b", "\xc3\xa9"})
    CHECK_FALSE(is_sensor_name(name));
  CHECK_FALSE(is_sensor_name(std::string(65, 'a')));
}

TEST_CASE("Where a calibration's distortion folds inside the image, pixels are dark") {
  Calibration c = calibration();
  CHECK_FALSE(sensor_of(c, 10e-6).dark_beyond_fold);
  c.distortion = BrownConrady{-1.0, 0.0, 0.0, 0.0, 0.0};
  const Sensor sensor = sensor_of(c, 10e-6);
  CHECK(sensor.dark_beyond_fold);
  CHECK(sensor_block(sensor)["distortion"]["beyond"] == "dark");
  CHECK(loaded(sensor).dark_beyond_fold);
}

TEST_CASE("Binned pixels are as large as the pixels that make them") {
  Calibration c = calibration();
  c.binning = {2, 4};
  const Sensor sensor = sensor_of(c, 10e-6);
  CHECK(sensor.pixel_pitch_m.x == 20e-6);
  CHECK(sensor.focal_length_m == 612.5 * 20e-6);
  check_against_opencv(c, sensor);
}

TEST_CASE("A camera's pose is a chain of the first one's and its own in that") {
  SetupFixture fixture;
  const Pose own{glm::dmat3(0, -1, 0, 1, 0, 0, 0, 0, 1), {0.1, 0.2, 0.3}};
  fixture.sensor()["pose"] = json::parse(pose_block(own).dump());
  const Pose loaded_pose = fixture.load().start.sensors.at(0).world_from_camera;
  const Pose expected = compose(node_from_camera(), own);
  CHECK(glm::distance(loaded_pose.translation_m, expected.translation_m) < 1e-15);
  CHECK(loaded_pose.direction({1, 0, 0}) == expected.direction({1, 0, 0}));
}

TEST_CASE("Figures beyond a setup's ranges are errors") {
  Calibration c = calibration();
  c.camera_matrix_at = {"K", {"camera.yml", 2, 1}};
  c.fx = 1e9;
  CHECK_THAT(error_of(c), EndsWith("camera.yml:2:1: K: expected a focal length from 1e-09 to 1000 m, found "
                                   "10000 m at this pixel pitch"));
  c = calibration();
  c.fy = 1e-300;
  CHECK_THAT(error_of(c), Contains("expected a pixel pitch along the rows from 1e-09 to 1000 m"));
  c = calibration();
  c.cx = 1e300;
  CHECK_THAT(error_of(c), Contains("expected a principal point from -1000 to 1000 m"));
}
