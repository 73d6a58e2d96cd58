#include "host/input/calibration/calibration_terms.h"
#include "host/input/calibration/camera_files.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

namespace pmdsim {
namespace {

constexpr std::size_t most_cameras = 64;

// The place of `camera` among `names`; the first where it is empty.
std::size_t place_of(const std::string &camera, const std::vector<std::string> &names,
                     const CalibrationMap &map) {
  const auto found = std::ranges::find(names, camera.empty() ? names.front() : camera);
  if (found == names.end())
    throw input_error(Place{map.file()}, fmt::format("--camera: expected {}, found {}",
                                                     fmt::join(names, " or "), in_quotes(camera)));
  return static_cast<std::size_t>(found - names.begin());
}

// A rotation as files round it, and a translation in metres.
Pose pose_of(const CalibrationKey &key, const glm::dmat3 &rotation, const glm::dvec3 &translation_m) {
  constexpr double rounding = 1e-4;
  const glm::dmat3 product = rotation * glm::transpose(rotation);
  double worst = glm::determinant(rotation) > 0.0 ? 0.0 : 1.0;
  for (glm::length_t i = 0; i < 3; ++i)
    for (glm::length_t j = 0; j < 3; ++j)
      worst = std::max(worst, std::abs(product[i][j] - (i == j ? 1.0 : 0.0)));
  if (!(worst <= rounding))
    throw input_error(key,
                      "expected a rotation and a translation, found a matrix that scales, shears or mirrors");
  return {rotation, translation_m};
}

// Rows of a 4 x 4 matrix.
Pose pose_of(const CalibrationEntry &entry) {
  const std::vector<double> m = numbers_of(entry, 16);
  if (m.size() != 16 || m[12] != 0.0 || m[13] != 0.0 || m[14] != 0.0 || m[15] != 1.0)
    throw input_error(entry.key, "expected 4 x 4 numbers, the last row 0, 0, 0, 1");
  return pose_of(entry.key, {m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]}, {m[3], m[7], m[11]});
}

std::string chain_name(std::size_t i) { return fmt::format("cam{}", i); }

CalibrationMap camera_map(const CalibrationMap &chain, const std::string &name) {
  const CalibrationEntry entry = chain.at({name});
  if (!entry.value.IsMap())
    throw input_error(entry.key, "expected a camera's keys: camera_model, intrinsics, distortion_model ...");
  return {entry.value, chain.file()};
}

DistortionModel kalibr_model(const CalibrationMap &camera) {
  static const std::map<std::string, DistortionModel> models{{"radtan", DistortionModel::brown},
                                                             {"equidistant", DistortionModel::fisheye},
                                                             {"none", DistortionModel::nameless}};
  const CalibrationEntry model = camera.at({"distortion_model"});
  const auto known = models.find(text_of(model));
  if (known == models.end())
    throw input_error(
        model.key, fmt::format("expected radtan, equidistant or none, found {}", in_quotes(text_of(model))));
  return known->second;
}

} // namespace

bool is_camchain(const CalibrationMap &map) { return map.find({"cam0"}).has_value(); }

Calibration camera_of_camchain(const CalibrationMap &map, const std::string &camera) {
  Calibration calibration;
  while (calibration.cameras.size() < most_cameras && map.find({chain_name(calibration.cameras.size())}))
    calibration.cameras.push_back(chain_name(calibration.cameras.size()));
  const std::size_t place = place_of(camera, calibration.cameras, map);
  calibration.name = chain_name(place);
  const CalibrationMap own = camera_map(map, calibration.name);
  if (const CalibrationEntry model = own.at({"camera_model"}); text_of(model) != "pinhole")
    throw input_error(model.key,
                      "expected pinhole, the only camera model of Kalibr's that pmdsim has, found " +
                          in_quotes(text_of(model)));
  const CalibrationEntry intrinsics = own.at({"intrinsics"});
  const std::vector<double> fx_fy_cx_cy = numbers_of(intrinsics, 4);
  if (fx_fy_cx_cy.size() != 4)
    throw input_error(intrinsics.key,
                      fmt::format("expected fx, fy, cx, cy, found {} numbers", fx_fy_cx_cy.size()));
  calibration.resolution = size_of(own.at({"resolution"}));
  set_camera_matrix(intrinsics.key, fx_fy_cx_cy, calibration);
  read_distortion(own.at({"distortion_coeffs"}), kalibr_model(own), calibration);
  for (std::size_t i = 1; i <= place; ++i)
    calibration.first_from_camera = compose(
        calibration.first_from_camera, inverse(pose_of(camera_map(map, chain_name(i)).at({"T_cn_cnm1"}))));
  return calibration;
}

bool is_pair(const CalibrationMap &map) { return map.find({"M1", "cameraMatrix1", "K1"}).has_value(); }

Calibration camera_of_pair(const CalibrationMap &map, const std::string &camera) {
  Calibration calibration;
  calibration.cameras = {"1", "2"};
  const std::string &number = calibration.cameras[place_of(camera, calibration.cameras, map)];
  calibration.name = "camera" + number;
  const CalibrationEntry size = map.at({"image_size", "imageSize", "size"});
  calibration.resolution = size_of(size);
  read_camera_matrix(map.at({"M" + number, "cameraMatrix" + number, "K" + number}), calibration);
  read_distortion(map.at({"D" + number, "distCoeffs" + number}), DistortionModel::brown, calibration);
  const auto rotation = map.find({"R"}), translation = map.find({"T"});
  if (number == "1" || !rotation || !translation)
    return calibration;
  const std::vector<double> r = numbers_of(*rotation, 9), t = numbers_of(*translation, 3);
  if (r.size() != 9 || t.size() != 3)
    throw input_error(rotation->key, "expected R of 3 x 3 and T of 3 numbers");
  calibration.first_from_camera = inverse(
      pose_of(rotation->key, {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]}, {t[0], t[1], t[2]}));
  return calibration;
}

} // namespace pmdsim
