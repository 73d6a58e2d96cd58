#include "host/input/calibration/calibration_file.h"

#include "host/input/calibration/calibration_yaml.h"
#include "host/input/file/input_file.h"
#include "host/input/schema/limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace pmdsim {
namespace {

constexpr std::size_t max_calibration_bytes = std::size_t{1} << 22;

// The names that OpenCV's programs, its tutorials, ROS and ROS 2 give to one thing.
const std::vector<std::string> camera_matrix_names{
    "camera_matrix", "cameraMatrix", "Camera_Matrix", "K", "k", "M"};
const std::vector<std::string> distortion_names{
    "distortion_coefficients", "Distortion_Coefficients", "dist_coeffs", "distCoeffs", "D", "d"};
const std::vector<std::string> size_or_width_names{"image_size", "imageSize", "image_width", "image_Width",
                                                   "width"};
const std::vector<std::string> height_names{"image_height", "image_Height", "height"};

constexpr const char *opencv_order[] = {"k1", "k2", "p1", "p2", "k3", "k4",   "k5",
                                        "k6", "s1", "s2", "s3", "s4", "tauX", "tauY"};
constexpr std::size_t first_rational = 5, first_prism = 8, tau_x = 12, tau_y = 13;

YAML::Node read_document(const std::filesystem::path &file) {
  const Place whole{file};
  const std::string text = read_regular_file(file, max_calibration_bytes, whole);
  const auto first = text.find_first_not_of("\xef\xbb\xbf \t\r\n");
  if (first != std::string::npos && text[first] == '<')
    throw input_error(whole, "XML is not read, expected YAML or JSON");
  const YAML::Node document = parse_yaml(text, file);
  if (!document.IsMap())
    throw input_error(whole, "expected a calibration, keys with values, in YAML or JSON");
  return document;
}

std::uint32_t pixels_of(const CalibrationKey &key, double number) {
  if (!(number >= 1.0 && number <= max_resolution) || number != std::floor(number))
    throw input_error(key, fmt::format("expected an integer from 1 to {}, found {}", max_resolution, number));
  return static_cast<std::uint32_t>(number);
}

glm::uvec2 resolution_of(const CalibrationMap &map) {
  const CalibrationEntry width = map.at(size_or_width_names);
  if (width.value.IsScalar()) {
    const CalibrationEntry height = map.at(height_names);
    return {pixels_of(width.key, number_of(width)), pixels_of(height.key, number_of(height))};
  }
  const std::vector<double> size = numbers_of(width, 2);
  if (size.size() != 2)
    throw input_error(width.key, fmt::format("expected width and height, found {} numbers", size.size()));
  return {pixels_of(width.key, size[0]), pixels_of(width.key, size[1])};
}

void read_camera_matrix(const CalibrationEntry &entry, Calibration &calibration) {
  const CalibrationKey &key = entry.key;
  const std::vector<double> m = numbers_of(entry, 9);
  if (m.size() != 9)
    throw input_error(key, fmt::format("expected 3 x 3 numbers, found {}", m.size()));
  if (m[1] != 0.0)
    throw input_error(key, fmt::format("expected 0 in row 1, column 2: pmdsim has no skew, found {}", m[1]));
  if (m[3] != 0.0 || m[6] != 0.0 || m[7] != 0.0 || m[8] != 1.0)
    throw input_error(key, "expected [fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  if (!(m[0] > 0.0) || !(m[4] > 0.0))
    throw input_error(key, fmt::format("expected fx and fy above 0, found {} and {}", m[0], m[4]));
  calibration.fx = m[0], calibration.cx = m[2];
  calibration.fy = m[4], calibration.cy = m[5];
}

enum class Model { brown, fisheye, nameless };

// By distortion_model. ROS's camera_info of a camera that nobody calibrated, or of a rectified image, has the
// empty one.
const std::map<std::string, Model> models{
    {"plumb_bob", Model::brown}, {"rational_polynomial", Model::brown}, {"equidistant", Model::fisheye},
    {"fisheye", Model::fisheye}, {"kannala_brandt", Model::fisheye},    {"", Model::nameless}};

Model model_of(const CalibrationMap &map) {
  if (const auto flag = map.find({"fisheye_model"})) {
    const double number = number_of(*flag);
    if (number != 0.0 && number != 1.0)
      throw input_error(flag->key, fmt::format("expected 0 or 1, found {}", number));
    if (number == 1.0)
      return Model::fisheye;
  }
  const auto model = map.find({"distortion_model"});
  if (!model)
    return Model::brown;
  const auto known = models.find(text_of(*model));
  if (known == models.end())
    throw input_error(model->key,
                      fmt::format("expected plumb_bob, rational_polynomial, equidistant, fisheye or "
                                  "kannala_brandt, found {}",
                                  in_quotes(text_of(*model))));
  return known->second;
}

void read_brown(const CalibrationKey &key, std::vector<double> d, Calibration &calibration) {
  constexpr std::array<std::size_t, 5> sizes{4, 5, 8, 12, 14};
  if (std::ranges::find(sizes, d.size()) == sizes.end())
    throw input_error(key, fmt::format("expected 4, 5, 8, 12 or 14 numbers, found {}", d.size()));
  d.resize(std::size(opencv_order));
  for (std::size_t term = first_rational; term < tau_x; ++term)
    if (d[term] != 0.0)
      throw input_error(key,
                        fmt::format("{}: expected 0: pmdsim has no {} terms, found {}", opencv_order[term],
                                    term < first_prism ? "rational" : "thin prism", d[term]));
  for (const std::size_t tilt : {tau_x, tau_y})
    if (std::abs(glm::degrees(d[tilt])) > max_chip_tilt_deg)
      throw input_error(key, fmt::format("{}: expected a tilt within {} degrees, found {} rad",
                                         opencv_order[tilt], max_chip_tilt_deg, d[tilt]));
  if (std::any_of(d.begin(), d.begin() + first_rational, [](double c) { return c != 0.0; }))
    calibration.distortion = BrownConrady{d[0], d[1], d[2], d[3], d[4]};
  calibration.tau_x_rad = d[tau_x];
  calibration.tau_y_rad = d[tau_y];
}

void read_distortion(const CalibrationEntry &entry, Model model, Calibration &calibration) {
  const std::vector<double> d = numbers_of(entry, std::size(opencv_order));
  for (const double coefficient : d)
    if (std::abs(coefficient) > max_distortion)
      throw input_error(entry.key, fmt::format("expected coefficients from {} to {}, found {}",
                                               -max_distortion, max_distortion, coefficient));
  if (model == Model::nameless && !std::ranges::all_of(d, [](double c) { return c == 0.0; }))
    throw input_error(entry.key, "expected no coefficients but 0 beside an empty distortion_model");
  if (model == Model::nameless || (model == Model::brown && d.empty()))
    return;
  if (model == Model::brown)
    return read_brown(entry.key, d, calibration);
  if (d.size() != 4) // an empty list, too: a fisheye without coefficients is no pinhole
    throw input_error(entry.key, fmt::format("expected the fisheye's k1 to k4, found {} numbers", d.size()));
  calibration.distortion = Fisheye{d[0], d[1], d[2], d[3]};
}

} // namespace

Error input_error(const CalibrationKey &key, const std::string &message) {
  return input_error(key.place, fmt::format("{}: {}", key.name, message));
}

Calibration read_calibration(const std::filesystem::path &file) {
  const CalibrationMap map(read_document(file), file);
  Calibration calibration;
  if (const auto name = map.find({"camera_name"}))
    calibration.name = text_of(*name);
  calibration.resolution = resolution_of(map);
  const CalibrationEntry matrix = map.at(camera_matrix_names);
  read_camera_matrix(matrix, calibration);
  const CalibrationEntry distortion = map.at(distortion_names);
  read_distortion(distortion, model_of(map), calibration);
  calibration.camera_matrix_at = matrix.key;
  calibration.distortion_at = distortion.key;
  return calibration;
}

} // namespace pmdsim
