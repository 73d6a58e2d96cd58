#include "host/input/calibration/calibration_file.h"

#include "host/input/calibration/calibration_xml.h"
#include "host/input/calibration/calibration_yaml.h"
#include "host/input/calibration/camera_files.h"
#include "host/input/file/input_file.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr std::size_t max_calibration_bytes = std::size_t{1} << 22;

YAML::Node read_document(const std::filesystem::path &file) {
  const Place whole{file};
  const std::string text = read_regular_file(file, max_calibration_bytes, whole);
  const auto first = text.find_first_not_of("\xef\xbb\xbf \t\r\n");
  const bool is_xml = first != std::string::npos && text[first] == '<';
  const YAML::Node document = is_xml ? parse_opencv_xml(text, file) : parse_yaml(text, file);
  if (!document.IsMap())
    throw input_error(whole, "expected a calibration, keys with values, in YAML, JSON or XML");
  return document;
}

} // namespace

Error input_error(const CalibrationKey &key, const std::string &message) {
  return input_error(key.place, fmt::format("{}: {}", key.name, message));
}

Calibration read_calibration(const std::filesystem::path &file, const std::string &camera) {
  const CalibrationMap map(read_document(file), file);
  if (is_camchain(map))
    return camera_of_camchain(map, camera);
  if (is_pair(map))
    return camera_of_pair(map, camera);
  if (!camera.empty())
    throw input_error(Place{file},
                      fmt::format("--camera: the file has one camera, found {}", in_quotes(camera)));
  return single_camera(map);
}

} // namespace pmdsim
