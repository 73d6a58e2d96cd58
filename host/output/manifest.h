#pragma once
// manifest.json: what an output directory holds and how it came about.
//
// From distances to points: `distance_m` is radial, from the lens to the point along the pixel's ray, NOT the
// depth z. With u the column, v the row and fx, fy, cx, cy of the frame's `camera`,
//   point_camera = distance_m * normalize([(u - cx) / fx, (v - cy) / fy, 1])
//   point_world  = world_from_camera * [point_camera, 1]
// The same holds for `range_m`, the true distance; `z_m` is the depth: point_camera = z_m * [(u-cx)/fx,
// (v-cy)/fy, 1].

#include "engine/measurement.h"
#include "engine/sensor.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// One sensor's frame and the files that hold it.
struct FrameRecord {
  Sensor sensor;
  std::uint32_t frame = 0;
  double frame_ms = 0.0;
  std::vector<PassTime> passes;
  std::vector<std::string> outputs; // file names without directory
};

struct RunRecord {
  std::string command; // "render" or "deform"
  std::string device, driver;
  std::string mode = "exact";
  nlohmann::ordered_json setup; // as used
  std::vector<FrameRecord> frames;
};

// fx, fy, cx, cy, camera_matrix (3 x 3), distortion (k1, k2, p1, p2, k3), world_from_camera (4 x 4, rows;
// camera frame x right, y down, z forward; world as in glTF).
nlohmann::ordered_json camera_json(const Sensor &sensor);

// {"NAME": milliseconds, ...}
nlohmann::ordered_json passes_json(const std::vector<PassTime> &passes);

nlohmann::ordered_json manifest_json(const RunRecord &run);

// Indented, with a final newline; a NaN becomes null.
std::string json_text(const nlohmann::ordered_json &json);

} // namespace pmdsim
