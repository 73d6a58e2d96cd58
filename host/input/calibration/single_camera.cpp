#include "host/input/calibration/calibration_terms.h"
#include "host/input/calibration/camera_files.h"
#include "host/input/calibration/readout.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>

namespace pmdsim {
namespace {

// The names that OpenCV's programs, its tutorials, ROS and ROS 2 give to one thing.
struct Names {
  std::vector<std::string> camera_matrix{
      "camera_matrix", "cameraMatrix", "Camera_Matrix", "intrinsic_matrix", "K", "k", "M"};
  std::vector<std::string> distortion{
      "distortion_coefficients", "Distortion_Coefficients", "dist_coeffs", "distCoeffs", "coeffs", "D", "d"};
  std::vector<std::string> size_or_width{"image_size",  "imageSize", "resolution", "image_width",
                                         "image_Width", "img_width", "width"};
  std::vector<std::string> height{"image_height", "image_Height", "img_height", "height"};
};

const Names &names() {
  static const Names names;
  return names;
}

glm::uvec2 resolution_of(const CalibrationMap &map) {
  const CalibrationEntry width = map.at(names().size_or_width);
  if (!width.value.IsScalar())
    return size_of(width);
  const CalibrationEntry height = map.at(names().height);
  return {pixels_of(width.key, number_of(width)), pixels_of(height.key, number_of(height))};
}

// By distortion_model or model. ROS's camera_info of a camera that nobody calibrated, or of a rectified
// image, has the empty one.
const std::map<std::string, DistortionModel> &models() {
  static const std::map<std::string, DistortionModel> models{{"plumb_bob", DistortionModel::brown},
                                                             {"rational_polynomial", DistortionModel::brown},
                                                             {"equidistant", DistortionModel::fisheye},
                                                             {"fisheye", DistortionModel::fisheye},
                                                             {"kannala_brandt", DistortionModel::fisheye},
                                                             {"Brown Conrady", DistortionModel::brown},
                                                             {"Kannala Brandt4", DistortionModel::fisheye},
                                                             {"None", DistortionModel::nameless},
                                                             {"", DistortionModel::nameless}};
  return models;
}

DistortionModel model_of(const CalibrationMap &map) {
  if (const auto flag = map.find({"fisheye_model"})) {
    const double number = number_of(*flag);
    if (number != 0.0 && number != 1.0)
      throw input_error(flag->key, fmt::format("expected 0 or 1, found {}", number));
    if (number == 1.0)
      return DistortionModel::fisheye;
  }
  const auto model = map.find({"distortion_model", "model"});
  if (!model)
    return DistortionModel::brown;
  const auto known = models().find(text_of(*model));
  if (known == models().end())
    throw input_error(model->key,
                      fmt::format("expected plumb_bob, rational_polynomial, equidistant, fisheye or "
                                  "kannala_brandt, found {}",
                                  in_quotes(text_of(*model))));
  return known->second;
}

void read_matrix(const CalibrationMap &map, Calibration &calibration) {
  if (const auto fx = map.find({"fx", "fl_x"})) {
    const CalibrationEntry fy = map.at({"fy", "fl_y"}), cx = map.at({"cx", "ppx"}),
                           cy = map.at({"cy", "ppy"});
    return set_camera_matrix(fx->key, {number_of(*fx), number_of(fy), number_of(cx), number_of(cy)},
                             calibration);
  }
  const CalibrationEntry matrix = map.at(names().camera_matrix);
  const bool by_columns = matrix.key.name == "intrinsic_matrix" && matrix.value.IsSequence();
  read_camera_matrix(matrix, calibration, by_columns ? MatrixOrder::columns : MatrixOrder::rows);
}

// Coefficients with a key each.
void read_named_distortion(const CalibrationMap &map, Calibration &calibration) {
  constexpr std::array brown{"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  std::vector<double> coefficients(brown.size());
  CalibrationKey key = calibration.camera_matrix_at;
  for (std::size_t i = 0; i < brown.size(); ++i)
    if (const auto entry = map.find({brown[i]})) {
      coefficients[i] = number_of(*entry);
      key = entry->key;
    }
  if (model_of(map) == DistortionModel::fisheye)
    coefficients = {coefficients[0], coefficients[1], coefficients[4], coefficients[5]};
  set_distortion(key, coefficients, model_of(map), calibration);
}

void read_any_distortion(const CalibrationMap &map, Calibration &calibration) {
  if (const auto distortion = map.find(names().distortion))
    return read_distortion(*distortion, model_of(map), calibration);
  // Files of OpenCV and ROS have coefficients beside their matrix; plain intrinsics may have none.
  const std::string &matrix = calibration.camera_matrix_at.name;
  if (matrix != "fx" && matrix != "fl_x" && matrix != "intrinsic_matrix")
    map.at(names().distortion);
  read_named_distortion(map, calibration);
}

} // namespace

Calibration single_camera(const CalibrationMap &map) {
  Calibration calibration;
  if (const auto name = map.find({"camera_name"}))
    calibration.name = text_of(*name);
  calibration.resolution = resolution_of(map);
  read_matrix(map, calibration);
  read_any_distortion(map, calibration);
  apply_readout(map, calibration);
  return calibration;
}

} // namespace pmdsim
