#include "engine/lens/lens.h"
#include "host/output/files/manifest.h"
#include "host/output/run/run_folder.h"
#include "tests/host/output/directory_content.h"
#include "tests/support/random_scenes.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace pmdsim;

namespace {

// 4 x 2 pixels, not square, focused at 1 m: S2 = 1/(1/0.1 - 1/1) = 1/9 m.
Sensor small_sensor() {
  Sensor sensor;
  sensor.resolution = {4, 2};
  sensor.pixel_pitch_m = {1e-3, 2e-3};
  sensor.focal_length_m = 0.1;
  sensor.focus_distance_m = 1.0;
  return sensor;
}

// A lens of the given model (pinhole, brown, fisheye) over a chip that is shifted and perhaps tilted and
// turned.
Sensor random_sensor(test::Random &random, int model, bool tilted, bool turned) {
  Sensor sensor;
  sensor.resolution = {640, 480};
  sensor.pixel_pitch_m = {random.uniform(5e-6, 50e-6), random.uniform(5e-6, 50e-6)};
  sensor.focal_length_m = random.uniform(4e-3, 20e-3);
  sensor.focus_distance_m = random.uniform(0.5, 5.0);
  if (model == 1)
    sensor.distortion =
        BrownConrady{random.uniform(-0.2, 0.2), random.uniform(-0.1, 0.1), random.uniform(-0.01, 0.01),
                     random.uniform(-0.01, 0.01), random.uniform(-0.05, 0.05)};
  if (model == 2)
    sensor.distortion = Fisheye{random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05),
                                random.uniform(-0.02, 0.02), random.uniform(-0.01, 0.01)};
  if (tilted)
    sensor.chip.rotation_rad = random.in_box({-0.3, -0.3, 0.0}, {0.3, 0.3, 0.0});
  if (turned)
    sensor.chip.rotation_rad.z = random.uniform(-3.0, 3.0);
  sensor.chip.translation_m = random.in_box(glm::dvec3(-1e-3), glm::dvec3(1e-3));
  return sensor;
}

// As a run leaves it that has these frames.
nlohmann::json manifest_of(const RunHead &run, const std::vector<FrameRecord> &frames) {
  const test::TemporaryFolder folder;
  RunFolder run_folder(folder.path(), {head_json(run), "hash"}, {0, 10}, RunFolder::Earlier::made_again,
                       [] {});
  for (const FrameRecord &frame : frames) {
    REQUIRE(run_folder.claim(frame.frame) == RunFolder::Claim::granted);
    OutputSet files(folder.path());
    for (const auto &[name, bytes] : frame.outputs)
      files.add(name, [size = bytes](OutputFile &file) { file.write(std::string(size, ' ')); });
    RunFolder::add_record(files, record_json("hash", {frame}));
    run_folder.publish(files, frame.frame);
  }
  CHECK(run_folder.write_manifest() == frames.size());
  return nlohmann::json::parse(content_of(folder.path() / "manifest.json"));
}

// calib3d's documentation: x'', y'' from the slopes.
glm::dvec2 opencv_distorted(const nlohmann::ordered_json &camera, const glm::dvec3 &ray) {
  const double x = ray.x / ray.z, y = ray.y / ray.z, r2 = x * x + y * y;
  const auto d = camera["distortion"].get<std::vector<double>>();
  if (camera["model"] == "fisheye") {
    const double r = std::sqrt(r2), theta = std::atan(r), t2 = theta * theta;
    const double theta_d =
        theta * (1 + d[0] * t2 + d[1] * t2 * t2 + d[2] * t2 * t2 * t2 + d[3] * t2 * t2 * t2 * t2);
    return {theta_d / r * x, theta_d / r * y};
  }
  const double radial = 1 + d[0] * r2 + d[1] * r2 * r2 + d[4] * r2 * r2 * r2;
  return {x * radial + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x),
          y * radial + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y};
}

// The same documentation's tilted sensor: x''', y''' of x'', y''. glm takes columns.
glm::dvec2 opencv_tilted(const glm::dvec2 &tau, const glm::dvec2 &distorted) {
  const glm::dmat3 about_y(std::cos(tau.y), 0, std::sin(tau.y), 0, 1, 0, -std::sin(tau.y), 0,
                           std::cos(tau.y));
  const glm::dmat3 about_x(1, 0, 0, 0, std::cos(tau.x), -std::sin(tau.x), 0, std::sin(tau.x),
                           std::cos(tau.x));
  const glm::dmat3 r = about_y * about_x;
  const glm::dmat3 onto_plane(r[2][2], 0, 0, 0, r[2][2], 0, -r[2][0], -r[2][1], 1);
  const glm::dvec3 projected = onto_plane * r * glm::dvec3(distorted, 1.0);
  return glm::dvec2(projected) / projected.z;
}

glm::dvec2 opencv_pixel(const nlohmann::ordered_json &camera, const glm::dvec3 &ray) {
  glm::dvec2 tau(0.0);
  if (camera.contains("tilt_rad"))
    tau = {camera["tilt_rad"][0].get<double>(), camera["tilt_rad"][1].get<double>()};
  else if (camera["distortion"].size() == 14)
    tau = {camera["distortion"][12].get<double>(), camera["distortion"][13].get<double>()};
  const glm::dvec2 m = opencv_tilted(tau, opencv_distorted(camera, ray));
  const auto row = [&](std::size_t i) {
    const auto &matrix = camera["camera_matrix"][i];
    return matrix[0].get<double>() * m.x + matrix[1].get<double>() * m.y + matrix[2].get<double>();
  };
  CHECK(row(2) == 1.0);
  return {row(0), row(1)};
}

} // namespace

TEST_CASE("a point on a pixel's ray projects onto that pixel") {
  const Sensor sensor = small_sensor();
  const auto camera = camera_json(sensor);
  CHECK(camera["model"] == "pinhole");
  const double fx = camera["fx"], fy = camera["fy"], cx = camera["cx"], cy = camera["cy"];
  for (std::uint32_t column = 0; column < 4; ++column)
    for (std::uint32_t row = 0; row < 2; ++row) {
      // The pixel's centre on the chip, by the design's formula, seen at a depth of 3 m.
      const double x_m = (column + 0.5 - 4 / 2.0) * 1e-3 / (1.0 / 9.0) * 3.0;
      const double y_m = (row + 0.5 - 2 / 2.0) * 2e-3 / (1.0 / 9.0) * 3.0;
      CHECK(fx * x_m / 3.0 + cx == Approx(column).margin(1e-12));
      CHECK(fy * y_m / 3.0 + cy == Approx(row).margin(1e-12));
    }
}

TEST_CASE("the manifest's camera takes distances to points of the world") {
  Sensor sensor = small_sensor();
  // Camera x is the world's z, camera y its x, camera z its y.
  sensor.world_from_camera = {glm::dmat3(0, 0, 1, 1, 0, 0, 0, 1, 0), {10, 20, 30}};
  const auto camera = camera_json(sensor);
  const auto matrix = [&](std::size_t row, std::size_t column) {
    return camera["camera_matrix"][row][column].get<double>();
  };
  const glm::dvec3 ray = glm::normalize(
      glm::dvec3((3 - matrix(0, 2)) / matrix(0, 0), (1 - matrix(1, 2)) / matrix(1, 1), 1.0)); // pixel (3, 1)
  const glm::dvec4 point_camera(2.0 * ray, 1.0);
  glm::dvec4 point_world(0.0);
  for (std::uint32_t row = 0; row < 4; ++row)
    for (std::uint32_t column = 0; column < 4; ++column)
      point_world[static_cast<int>(row)] +=
          camera["world_from_camera"][row][column].get<double>() * point_camera[static_cast<int>(column)];
  const glm::dvec3 direction = glm::normalize(glm::dvec3(1.5e-3, 1e-3, 1.0 / 9.0));
  CHECK(point_world.x == Approx(10 + 2.0 * direction.y));
  CHECK(point_world.y == Approx(20 + 2.0 * direction.z));
  CHECK(point_world.z == Approx(30 + 2.0 * direction.x));
  CHECK(point_world.w == 1.0);
}

TEST_CASE("OpenCV's formulas with the manifest's figures project rays as the lens does") {
  test::Random random(20260);
  for (int i = 0; i < 60; ++i) {
    const Sensor sensor = random_sensor(random, i % 3, i % 2 == 0, i % 4 < 2);
    const auto camera = camera_json(sensor);
    const Lens lens(sensor);
    for (int k = 0; k < 20; ++k) {
      const glm::dvec3 ray = glm::normalize(random.in_box({-0.5, -0.5, 1.0}, {0.5, 0.5, 1.0}));
      const auto chip_m = lens.chip_m(ray);
      REQUIRE(chip_m);
      // The centre of the first pixel lies at (0, 0) in OpenCV, and at (0.5, 0.5) in the lens.
      const glm::dvec2 expected = lens.pixel(*chip_m) - 0.5;
      INFO(camera.dump(1));
      CHECK(glm::distance(opencv_pixel(camera, ray), expected) < 1e-9);
    }
  }
}

TEST_CASE("the camera has as many distortion figures as OpenCV's model needs") {
  Sensor sensor = small_sensor();
  const auto distortion = [&] { return camera_json(sensor)["distortion"].get<std::vector<double>>(); };
  CHECK(distortion() == std::vector<double>(5, 0.0));
  sensor.distortion = BrownConrady{0.1, 0.2, 0.3, 0.4, 0.5};
  CHECK(distortion() == std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5});
  sensor.chip.rotation_rad = {0.01, -0.02, 0.0};
  CHECK(distortion() == std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0, 0, 0, 0, 0, 0.01, -0.02});
  CHECK_FALSE(camera_json(sensor).contains("tilt_rad"));
  sensor.distortion = Fisheye{0.1, 0.2, 0.3, 0.4};
  CHECK(distortion() == std::vector<double>{0.1, 0.2, 0.3, 0.4});
  CHECK(camera_json(sensor)["tilt_rad"] == nlohmann::json{0.01, -0.02});
}

TEST_CASE("a chip turned about the axis has no focal lengths but a whole matrix") {
  Sensor sensor = small_sensor();
  sensor.chip.rotation_rad.z = 0.5;
  const auto camera = camera_json(sensor);
  CHECK(camera["fx"].is_null());
  CHECK(camera["fy"].is_null());
  // A place on the chip's own x axis lies towards +x and +y of the camera: its pixel's column grows with
  // both.
  CHECK(camera["camera_matrix"][0][0].get<double>() == Approx(1.0 / 9.0 / 1e-3 * std::cos(0.5)));
  CHECK(camera["camera_matrix"][0][1].get<double>() == Approx(1.0 / 9.0 / 1e-3 * std::sin(0.5)));
  CHECK(camera["camera_matrix"][1][0].get<double>() == Approx(-1.0 / 9.0 / 2e-3 * std::sin(0.5)));
  CHECK(camera["cx"] == 1.5);
}

TEST_CASE("a manifest lists frames and outputs, and knows no error of the exact mode") {
  const RunHead run{.command = "render",
                    .device = "some device",
                    .driver = "some driver",
                    .setup = {{"scene", "wall.gltf"}},
                    .inputs = {{{"file", "wall.gltf"}}},
                    .formats = {"exr"}};
  const auto manifest = manifest_of(
      run, {{small_sensor(), 7, 0.35, 1.5, {{"accumulate", 1.25}}, Mode::exact, {}, {}, {{"pmd_0007.exr"}}},
            {small_sensor(), 8, 0.40, 1.5, {}, Mode::exact, {}, {}, {{"pmd_0008.exr"}}}});
  CHECK(manifest["run"] == "hash");
  CHECK(manifest["formats"] == nlohmann::json{"exr"});
  CHECK(manifest["inputs"][0]["file"] == "wall.gltf");
  CHECK_FALSE(manifest.contains("paths"));
  CHECK(manifest["setup"]["scene"] == "wall.gltf");
  CHECK(manifest["device"] == "some device");
  REQUIRE(manifest["frames"].size() == 2);
  CHECK(manifest["frames"][1]["outputs"] == nlohmann::json{"pmd_0008.exr"});
  const auto &frame = manifest["frames"].at(0);
  CHECK(frame["sensor"] == "pmd");
  CHECK(frame["frame"] == 7);
  CHECK(frame["time_s"] == 0.35);
  CHECK(frame["tap_interval_s"] == 0.0);
  for (const char *time : {"frame_ms", "passes_ms", "check_ms"}) // so that every run's manifest is the same
    CHECK_FALSE(frame.contains(time));
  CHECK(frame["error_claimed_m"].is_null());
  CHECK(frame["outputs"] == nlohmann::json{"pmd_0007.exr"});
  CHECK(frame["modulation_hz"] == nlohmann::json{20e6});
  CHECK(frame["ambiguity_m"].at(0).get<double>() == Approx(299792458.0 / 40e6));
  CHECK(frame["waveform"] == "sine");
  CHECK(frame["taps"] == 4);
  CHECK(frame["camera"]["distortion"] == nlohmann::json{0.0, 0.0, 0.0, 0.0, 0.0});
}

TEST_CASE("a manifest tells what error was asked for, and what each frame came to") {
  RunHead run{.command = "render", .device = "device", .driver = "driver"};
  run.accuracy.mode = Mode::automatic;
  run.accuracy.max_error_m = 1e-4;
  run.accuracy.precision = Precision::fp64;
  AccuracyReport accuracy;
  accuracy.diodes = 15;
  accuracy.claimed_m = 3e-5;
  accuracy.found_m = 2e-5;
  const auto manifest = manifest_of(run, {{small_sensor(), 0, 0.0, 1.5, {}, Mode::exact, {}, {}},
                                          {small_sensor(), 1, 0.0, 1.5, {}, Mode::automatic, accuracy, {}}});
  CHECK(manifest["precision"] == "fp64");
  CHECK(manifest["mode"] == "auto");
  CHECK(manifest["max_error_m"] == 1e-4);
  CHECK(manifest["max_amplitude_error"].is_null());
  CHECK(manifest["frames"][0]["mode"] == "exact");
  CHECK(manifest["frames"][1]["mode"] == "auto");
  CHECK(manifest["frames"][1]["diodes"] == 15);
  CHECK(manifest["frames"][1]["error_claimed_m"] == 3e-5);
  CHECK(manifest["frames"][1]["error_found_m"] == 2e-5);
}

TEST_CASE(
    "a frame of several frequencies has an ambiguity range each, and its waveform as a setup writes it") {
  Sensor sensor = small_sensor();
  sensor.modulation_hz = {20e6, 30e6};
  sensor.waveform = {Waveform::Kind::harmonics, {1.0, 0.1}};
  const auto frame = frame_json({sensor, 0, 0.0, 1.0, {}, Mode::exact, {}, {}});
  CHECK(frame["modulation_hz"] == nlohmann::ordered_json{20e6, 30e6});
  CHECK(frame["ambiguity_m"].at(1).get<double>() == Approx(299792458.0 / 60e6));
  CHECK(frame["waveform"]["harmonics"] == nlohmann::ordered_json{1.0, 0.1});
  CHECK(waveform_json({Waveform::Kind::square, {}}) == "square");
}

TEST_CASE("NaN is null in JSON") {
  CHECK(json_text({{"mean", std::numeric_limits<double>::quiet_NaN()}}) == "{\n  \"mean\": null\n}\n");
}

TEST_CASE("JSON that is written in pieces is that which is written at once") {
  const nlohmann::ordered_json head{{"a", 1}, {"b", {{"c", {1, 2}}}}};
  nlohmann::ordered_json whole = head;
  whole["list"] = {{{"d", 1.5}, {"e", {1, 2}}}, 3};
  whole["none"] = nlohmann::ordered_json::array();
  std::string text;
  JsonPieces pieces([&](std::string_view piece) { text += piece; }, head);
  pieces.list("list", [&](const JsonPieces::Add &add) {
    for (const auto &element : whole["list"])
      add(element);
  });
  pieces.list("none", [](const JsonPieces::Add &) {});
  pieces.end();
  CHECK(text == json_text(whole));
}
