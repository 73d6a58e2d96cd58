#pragma once
// manifest.json: what an output directory holds and how it came about; and the JSON of which it is made,
// which commands print, too.
//
// From distances to points: `distance_m` is radial, from the lens to the point along the pixel's ray, NOT the
// depth z. With the frame's `camera` (camera_json() says what its figures mean) and the slopes (x, y) of the
// pixel's ray,
//   (x''', y''', 1) = inverse(camera_matrix) * (column, row, 1)
//   (x, y)          = (x''', y''') less tilt and distortion, by OpenCV
//   point_camera    = distance_m * normalize([x, y, 1])
//   point_world     = world_from_camera * [point_camera, 1]
// The same holds for `range_m`, the true distance; `z_m` is the depth: point_camera = z_m * [x, y, 1].

#include "engine/model/measurement.h"
#include "engine/model/sensor.h"
#include "engine/model/warning.h"

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

// A file that is written: its name without directory.
struct NamedFile {
  std::string name;
  std::uint64_t bytes = 0;
};

// One sensor's frame and the files that hold it.
struct FrameRecord {
  Sensor sensor; // where it was when the frame began
  std::uint32_t frame = 0;
  double time_s = 0.0; // when it began
  double frame_ms = 0.0;
  std::vector<PassTime> passes;
  Mode mode = Mode::exact; // that it was taken in
  AccuracyReport accuracy;
  std::optional<BouncesReport> bounces{}; // nothing without
  std::vector<NamedFile> outputs{};
  nlohmann::ordered_json told{}; // what the command tells of it beyond that
  // What pictures of the whole run need of it (host/output/sheets/sheets.h), if they show it.
  nlohmann::ordered_json thumbnails{};
  std::vector<Warning> warnings{}; // about it; the place of each is the sensor
};

// Of distances in files that know double (NPY, NPZ, HDF5; EXR has them as two channels).
enum class OutputPrecision { float32, float64 };
// As the command line has them: "float32", "float64".
std::string output_precision_name(OutputPrecision precision);

// What a run is, its frames aside: all that decides what they hold.
struct RunHead {
  std::string command{}; // "render" or "deform"
  std::string device{}, driver{};
  Accuracy accuracy{};                // asked for
  std::uint32_t paths = 0;            // asked of the reference; 0: as many as it chooses
  nlohmann::ordered_json setup{};     // as used
  std::vector<std::string> objects{}; // their names, by object_id
  nlohmann::ordered_json inputs = nlohmann::ordered_json::array(); // the files that went into it
  std::vector<std::string> formats{};
  std::vector<std::string> channels{}; // asked for; none: all
  OutputPrecision output_precision = OutputPrecision::float32;
  std::vector<Warning> warnings{}; // about the setup
};

// As the command line has them: "exact", "reduced", "auto"; "fp32", "fp64".
std::string mode_name(Mode mode);
std::string precision_name(Precision precision);

template <class Value>
nlohmann::ordered_json or_null(const std::optional<Value> &value) {
  return value ? nlohmann::ordered_json(*value) : nullptr;
}

// An array of what `json_of` makes of each.
nlohmann::ordered_json array_of(const auto &list, const auto &json_of) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const auto &each : list)
    array.push_back(json_of(each));
  return array;
}

// The sensor's lens and chip as OpenCV describes a camera: model ("pinhole", "brown" or "fisheye"), fx, fy
// (null where gamma is not 0: camera_matrix has four figures where OpenCV expects these two alone), cx, cy,
// camera_matrix (3 x 3), distortion, world_from_camera (4 x 4, rows; camera frame x right, y down, z forward;
// world as in glTF); of a tilted fisheye tilt_rad (tauX, tauY).
//
// A point (X, Y, Z) of the camera frame appears at the pixel camera_matrix * (x''', y''', 1), where (x''',
// y''') comes from the slopes (X/Z, Y/Z) by OpenCV's distortion and then its tilted sensor, tauX = alpha,
// tauY = beta of eq. 1; gamma is a rotation within camera_matrix, whose last row is 0, 0, 1. The CENTRE of
// pixel (0, 0) lies at (0, 0). Focal lengths follow from the image distance S2, not from the lens's own focal
// length. The distortion is in OpenCV's order. Pinhole and brown: k1, k2, p1, p2, k3, with a tilt all 14, of
// which tauX, tauY are the last. Fisheye: k1 to k4; OpenCV's has no tilt.
nlohmann::ordered_json camera_json(const Sensor &sensor);

// As a setup writes it: "sine", "square" or {"harmonics": [...]}.
nlohmann::ordered_json waveform_json(const Waveform &waveform);

// The ambiguity range of every frequency.
std::vector<double> ambiguities_m(const Sensor &sensor);

// precision, diodes (as AccuracyReport::diodes), error_claimed_m, error_found_m, amplitude_error_claimed,
// amplitude_error_found (relative), unpromised, checked_pixels, check_ms. An error is null where nothing is
// known of it.
nlohmann::ordered_json accuracy_json(const AccuracyReport &report);
// A frame's mode, then the keys of its report.
nlohmann::ordered_json accuracy_json(const FrameRecord &record);

// elements, lines, products, claimed_m (null where nothing is claimed).
nlohmann::ordered_json bounces_json(const BouncesReport &report);

// code, place, text.
nlohmann::ordered_json warning_json(const Warning &warning);
// Throws json::exception where it is none.
Warning warning_of(const nlohmann::ordered_json &json);

// index, name, kind, driver, usable, lacks.
nlohmann::ordered_json device_json(const DeviceInfo &device);

// [{"id": as in object_id, "name": of the glTF node}, ...]
nlohmann::ordered_json objects_json(const std::vector<std::string> &objects);

// {"NAME": milliseconds, ...}
nlohmann::ordered_json passes_json(const std::vector<PassTime> &passes);

// What stands in a manifest before its frames: program, version, command, device, driver, mode and errors
// that were asked for, formats, channels, output_precision, inputs, setup, objects, points, warnings of the
// setup.
nlohmann::ordered_json head_json(const RunHead &run);
// A frame as it stands there: what is the same whenever and wherever the run is made, so without times.
nlohmann::ordered_json frame_json(const FrameRecord &record);

// Indented, with a final newline; a NaN becomes null.
std::string json_text(const nlohmann::ordered_json &json);

// An object's json_text(), piece by piece, as a long run's lists are large.
class JsonPieces {
public:
  using Sink = std::function<void(std::string_view)>;
  // Writes what is in `head`, which has at least one key.
  JsonPieces(Sink sink, const nlohmann::ordered_json &head);

  // Writes a list; `fill` is called with what adds an element.
  using Add = std::function<void(const nlohmann::ordered_json &)>;
  void list(const std::string &key, const std::function<void(const Add &)> &fill);
  void end();

private:
  Sink sink_;
};

} // namespace pmdsim
