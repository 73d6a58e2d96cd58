#include "host/output/manifest.h"

#include "host/output/intrinsics.h"

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json matrix_json(const Pose &a_from_b) {
  ordered_json rows = ordered_json::array();
  for (int row = 0; row < 3; ++row)
    rows.push_back({a_from_b.rotation[0][row], a_from_b.rotation[1][row], a_from_b.rotation[2][row],
                    a_from_b.translation_m[row]});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

// The exact sum claims no error of its own and is not compared with anything here: both errors are unknown,
// null.
ordered_json frame_json(const FrameRecord &record) {
  return {{"sensor", record.sensor.name},
          {"frame", record.frame},
          {"resolution", {record.sensor.resolution.x, record.sensor.resolution.y}},
          {"modulation_hz", record.sensor.modulation_hz[0]},
          {"ambiguity_m", record.sensor.ambiguity_m()},
          {"camera", camera_json(record.sensor)},
          {"frame_ms", record.frame_ms},
          {"passes_ms", passes_json(record.passes)},
          {"error_claimed_m", nullptr},
          {"error_found_m", nullptr},
          {"outputs", record.outputs}};
}

} // namespace

ordered_json camera_json(const Sensor &sensor) {
  const auto [fx, fy, cx, cy] = intrinsics_of(sensor);
  return {{"model", "pinhole"},
          {"fx", fx},
          {"fy", fy},
          {"cx", cx},
          {"cy", cy},
          {"camera_matrix", {{fx, 0.0, cx}, {0.0, fy, cy}, {0.0, 0.0, 1.0}}},
          {"distortion", {0.0, 0.0, 0.0, 0.0, 0.0}},
          {"world_from_camera", matrix_json(sensor.world_from_camera)}};
}

ordered_json passes_json(const std::vector<PassTime> &passes) {
  ordered_json json = ordered_json::object();
  for (const PassTime &pass : passes)
    json[pass.name] = pass.ms;
  return json;
}

ordered_json manifest_json(const RunRecord &run) {
  ordered_json frames = ordered_json::array();
  for (const FrameRecord &record : run.frames)
    frames.push_back(frame_json(record));
  return {{"program", "pmdsim"},
          {"version", PMDSIM_VERSION},
          {"command", run.command},
          {"device", run.device},
          {"driver", run.driver},
          {"mode", run.mode},
          {"setup", run.setup},
          {"points",
           "point_world = world_from_camera * [distance_m * normalize([(column - cx) / fx, (row - cy) / fy, "
           "1]), 1]; distance_m is radial, not the depth z"},
          {"frames", frames}};
}

std::string json_text(const ordered_json &json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

} // namespace pmdsim
