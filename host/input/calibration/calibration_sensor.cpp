#include "host/input/calibration/calibration_sensor.h"

#include "host/input/schema/limits.h"
#include "host/input/setup/parts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

constexpr std::size_t max_name_length = 64;

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool is_of_a_name(char c) { return is_letter_or_digit(c) || c == '.' || c == '_' || c == '-'; }

std::string sensor_name(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return !is_of_a_name(c); }, '_');
  name.erase(name.begin(), std::ranges::find_if(name, is_letter_or_digit));
  name.resize(std::min(name.size(), max_name_length));
  return name.empty() ? "camera" : name;
}

void check_ranges(const Sensor &sensor, const CalibrationKey &key) {
  const auto check = [&](const char *what, double value_m, double min_m, double max_m) {
    if (!(value_m >= min_m && value_m <= max_m))
      throw input_error(key, fmt::format("expected {} from {} to {} m, found {} m at this pixel pitch", what,
                                         min_m, max_m, value_m));
  };
  check("a focal length", sensor.focal_length_m, min_length_m, max_length_m);
  check("a pixel pitch along the rows", sensor.pixel_pitch_m.y, min_length_m, max_length_m);
  for (int axis = 0; axis < 3; ++axis)
    check("a principal point", sensor.chip.translation_m[axis], -max_chip_shift_m, max_chip_shift_m);
}

ordered_json coefficients_block(const Distortion &distortion) {
  if (const auto *d = std::get_if<Fisheye>(&distortion))
    return {{"model", "fisheye"}, {"k1", d->k1}, {"k2", d->k2}, {"k3", d->k3}, {"k4", d->k4}};
  const auto &d = std::get<BrownConrady>(distortion);
  return {{"model", "brown"}, {"k1", d.k1}, {"k2", d.k2}, {"p1", d.p1}, {"p2", d.p2}, {"k3", d.k3}};
}

ordered_json distortion_block(const Sensor &sensor) {
  ordered_json block = coefficients_block(sensor.distortion);
  if (sensor.dark_beyond_fold)
    block["beyond"] = "dark";
  return block;
}

} // namespace

bool is_sensor_name(std::string_view name) {
  return !name.empty() && name.size() <= max_name_length && is_letter_or_digit(name.front()) &&
         std::ranges::all_of(name, is_of_a_name);
}

// OpenCV's tilt takes the slopes (x'', y'') behind the distortion to p = R (x'', y'', 1) with R = Ry Rx of
// its page on calib3d, which is (D1(tauX) D2(tauY))^T here, and a pixel is
//   u = fx (R33 px / pz - R13) + cx,   v = fy (R33 py / pz - R23) + cy.
// The ray meets our chip, at t in the camera frame and turned by R^T, with T = R t, at
//   x' = Tz px / pz - Tx,   y' = Tz py / pz - Ty.
// So Tz = fx pitch_x R33 = fy pitch_y R33, Tx = fx pitch_x R13 + pitch_x ((W - 1)/2 - cx), Ty alike: (R13,
// R23, R33) is R e_z, hence t = R^T T is the nominal place at the image distance fx pitch_x and, from there
// on, the shift of the principal point along the tilted chip.
Sensor sensor_of(const Calibration &calibration, double pixel_pitch_m) {
  Sensor sensor;
  sensor.name = sensor_name(calibration.name);
  sensor.resolution = calibration.resolution;
  sensor.pixel_pitch_m.x = pixel_pitch_m * calibration.binning.x;
  sensor.focal_length_m = calibration.fx * sensor.pixel_pitch_m.x;
  sensor.pixel_pitch_m.y = sensor.focal_length_m / calibration.fy;
  sensor.distortion = calibration.distortion;
  const glm::dvec2 shift_m =
      (0.5 * (glm::dvec2(sensor.resolution) - 1.0) - glm::dvec2(calibration.cx, calibration.cy)) *
      sensor.pixel_pitch_m;
  const double cos_x = std::cos(calibration.tau_x_rad), sin_x = std::sin(calibration.tau_x_rad);
  const double cos_y = std::cos(calibration.tau_y_rad), sin_y = std::sin(calibration.tau_y_rad);
  // The first two columns of D1(tauX) D2(tauY).
  const glm::dvec3 along_columns(cos_y, sin_x * sin_y, -cos_x * sin_y), along_rows(0.0, cos_x, sin_x);
  sensor.chip.rotation_rad = {calibration.tau_x_rad, calibration.tau_y_rad, 0.0};
  sensor.chip.translation_m = shift_m.x * along_columns + shift_m.y * along_rows;
  check_ranges(sensor, calibration.camera_matrix_at);
  if (const auto problem = lens_problem(sensor); problem && problem->key == "distortion")
    sensor.dark_beyond_fold = true; // as calibrations of wide lenses do in their corners
  if (const auto problem = lens_problem(sensor))
    throw input_error(problem->key == "resolution" ? calibration.camera_matrix_at : calibration.distortion_at,
                      problem->expectation);
  return sensor;
}

ordered_json pose_block(const Pose &first_from_camera) {
  const auto rows_of = [](const Pose &pose) {
    ordered_json rows = ordered_json::array();
    for (glm::length_t row = 0; row < 3; ++row)
      rows.push_back(
          {pose.rotation[0][row], pose.rotation[1][row], pose.rotation[2][row], pose.translation_m[row]});
    rows.push_back({0, 0, 0, 1});
    return rows;
  };
  return {{"chain", {{{"matrix", rows_of(node_from_camera())}}, {{"matrix", rows_of(first_from_camera)}}}}};
}

ordered_json sensor_block(const Sensor &sensor) {
  ordered_json block{{"name", sensor.name},
                     {"resolution", {sensor.resolution.x, sensor.resolution.y}},
                     {"pixel_pitch_m", {sensor.pixel_pitch_m.x, sensor.pixel_pitch_m.y}},
                     {"focal_length_m", sensor.focal_length_m}};
  if (!std::holds_alternative<std::monostate>(sensor.distortion))
    block["distortion"] = distortion_block(sensor);
  if (!sensor.chip.is_nominal()) {
    const glm::dvec3 rotation_deg = glm::degrees(sensor.chip.rotation_rad);
    const glm::dvec3 &shift_m = sensor.chip.translation_m;
    block["chip"] = {{"rotation_deg", {rotation_deg.x, rotation_deg.y, rotation_deg.z}},
                     {"translation_m", {shift_m.x, shift_m.y, shift_m.z}}};
  }
  block["modulation_hz"] = sensor.modulation_hz;
  return block;
}

} // namespace pmdsim
