#include "host/output/files/manifest.h"

#include <array>
#include <cmath>
#include <utility>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// The error that is bounded, null where none is.
ordered_json asked_json(const Accuracy &accuracy) {
  const auto bound = [&](double error) {
    return accuracy.mode == Mode::exact || std::isinf(error) ? ordered_json(nullptr) : ordered_json(error);
  };
  return {{"mode", mode_name(accuracy.mode)},
          {"max_error_m", bound(accuracy.max_error_m)},
          {"max_amplitude_error", bound(accuracy.max_amplitude_error)},
          {"precision", accuracy.precision ? ordered_json(precision_name(*accuracy.precision)) : nullptr}};
}

// All lines but the first begin with `spaces` more.
std::string indented(const ordered_json &json, std::size_t spaces) {
  std::string text;
  for (const char character : json_text(json)) {
    text += character;
    if (character == '\n')
      text.append(spaces, ' ');
  }
  return text.substr(0, text.find_last_not_of(" \n") + 1);
}

ordered_json how_to_make_points() {
  return {
      "1. xy = inverse(camera_matrix) * [column, row, 1]; the centre of pixel (0, 0) lies at (0, 0)",
      "2. pinhole, brown: [x, y] = cv::undistortPoints(xy, identity, distortion), iterated until it stands",
      "2. fisheye: [x, y] = cv::fisheye::undistortPoints(xy, identity, distortion), where there is a "
      "tilt_rad "
      "after cv::undistortPoints(xy, identity, [12 zeros, tilt_rad]); rays beyond 90 degrees have no slopes: "
      "solve the model for the angle to the axis",
      "3. point_world = world_from_camera * [distance_m * normalize([x, y, 1]), 1]; distance_m is radial, "
      "not the depth z; so is range_m, the true or, by `correct`, the corrected one"};
}

} // namespace

std::string mode_name(Mode mode) {
  constexpr std::array names{"exact", "reduced", "auto"}; // in the order of Mode
  return names.at(static_cast<std::size_t>(mode));
}

std::string precision_name(Precision precision) { return precision == Precision::fp64 ? "fp64" : "fp32"; }

ordered_json waveform_json(const Waveform &waveform) {
  if (waveform.kind == Waveform::Kind::harmonics)
    return {{"harmonics", waveform.harmonics}};
  return waveform.kind == Waveform::Kind::square ? "square" : "sine";
}

std::vector<double> ambiguities_m(const Sensor &sensor) {
  std::vector<double> ambiguities;
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
    ambiguities.push_back(sensor.ambiguity_m(i));
  return ambiguities;
}

ordered_json accuracy_json(const AccuracyReport &report) {
  return {{"precision", precision_name(report.precision)},
          {"diodes", report.diodes},
          {"error_claimed_m", or_null(report.claimed_m)},
          {"error_found_m", or_null(report.found_m)},
          {"amplitude_error_claimed", or_null(report.claimed_amplitude)},
          {"amplitude_error_found", or_null(report.found_amplitude)},
          {"unpromised", report.unpromised},
          {"checked_pixels", report.checked_pixels},
          {"check_ms", report.check_ms}};
}

ordered_json accuracy_json(const FrameRecord &record) {
  ordered_json json{{"mode", mode_name(record.mode)}};
  json.update(accuracy_json(record.accuracy));
  return json;
}

ordered_json bounces_json(const BouncesReport &report) {
  return {{"elements", report.elements},
          {"lines", report.lines},
          {"products", report.products},
          {"claimed_m", report.claimed_m}};
}

ordered_json warning_json(const Warning &warning) {
  return {{"code", warning.code}, {"place", warning.place}, {"text", warning.text}};
}

Warning warning_of(const ordered_json &json) {
  return {json.at("code").get<std::string>(), json.at("place").get<std::string>(),
          json.at("text").get<std::string>()};
}

ordered_json device_json(const DeviceInfo &device) {
  return {{"index", device.index},   {"name", device.name},     {"kind", device.kind},
          {"driver", device.driver}, {"usable", device.usable}, {"lacks", device.lacks}};
}

ordered_json objects_json(const std::vector<std::string> &objects) {
  ordered_json json = ordered_json::array();
  for (const std::string &name : objects)
    json.push_back({{"id", json.size()}, {"name", name}});
  return json;
}

ordered_json passes_json(const std::vector<PassTime> &passes) {
  ordered_json json = ordered_json::object();
  for (const PassTime &pass : passes)
    json[pass.name] = pass.ms;
  return json;
}

std::string output_precision_name(OutputPrecision precision) {
  return precision == OutputPrecision::float64 ? "float64" : "float32";
}

ordered_json head_json(const RunHead &run) {
  ordered_json head{{"program", "pmdsim"},
                    {"version", PMDSIM_VERSION},
                    {"command", run.command},
                    {"device", run.device},
                    {"driver", run.driver}};
  head.update(asked_json(run.accuracy));
  if (run.paths > 0)
    head["paths"] = run.paths;
  head["formats"] = run.formats;
  head["channels"] = run.channels.empty() ? ordered_json(nullptr) : ordered_json(run.channels);
  head["output_precision"] = output_precision_name(run.output_precision);
  head["inputs"] = run.inputs;
  head["setup"] = run.setup;
  head["objects"] = objects_json(run.objects);
  head["points"] = how_to_make_points();
  head["warnings"] = array_of(run.warnings, warning_json);
  return head;
}

ordered_json frame_json(const FrameRecord &record) {
  ordered_json frame{{"sensor", record.sensor.name},
                     {"frame", record.frame},
                     {"time_s", record.time_s},
                     {"resolution", {record.sensor.resolution.x, record.sensor.resolution.y}},
                     {"modulation_hz", record.sensor.modulation_hz},
                     {"ambiguity_m", ambiguities_m(record.sensor)},
                     {"waveform", waveform_json(record.sensor.waveform)},
                     {"taps", record.sensor.taps},
                     {"tap_interval_s", record.sensor.tap_interval_s},
                     {"camera", camera_json(record.sensor)}};
  frame.update(accuracy_json(record));
  frame.erase("check_ms");
  if (record.bounces)
    frame["bounces"] = bounces_json(*record.bounces);
  frame["outputs"] = array_of(record.outputs, [](const NamedFile &file) { return file.name; });
  if (!record.warnings.empty())
    frame["warnings"] = array_of(record.warnings, warning_json);
  return frame;
}

std::string json_text(const ordered_json &json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

JsonPieces::JsonPieces(Sink sink, const ordered_json &head) : sink_(std::move(sink)) {
  const std::string text = json_text(head);
  sink_(std::string_view(text).substr(0, text.find_last_of('}') - 1)); // without its end and that line's
}

void JsonPieces::list(const std::string &key, const std::function<void(const Add &)> &fill) {
  sink_(",\n  " + ordered_json(key).dump() + ": [");
  bool any = false;
  fill([&](const ordered_json &element) {
    sink_((std::exchange(any, true) ? ",\n    " : "\n    ") + indented(element, 4));
  });
  sink_(any ? "\n  ]" : "]");
}

void JsonPieces::end() { sink_("\n}\n"); }

} // namespace pmdsim
