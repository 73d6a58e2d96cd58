#include "host/input/setup/setup.h"

#include "host/input/file/input_file.h"
#include "host/input/file/json_file.h"
#include "host/input/gltf/loader.h"
#include "host/input/schema/schema_check.h"
#include "host/input/setup/parts.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <set>

namespace pmdsim {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

constexpr std::size_t max_setup_bytes = std::size_t{1} << 22;

void refuse_second_pattern(const json &document, const Place &root) {
  const json &illuminators = document.at("illuminators");
  for (std::size_t i = 0; i < illuminators.size(); ++i)
    if (illuminators[i].at("diodes").contains("file") && illuminators[i].contains("pattern"))
      throw input_error(root / "illuminators" / i / "pattern",
                        "expected none beside a diode file, which has its own");
}

// Defaults that depend on more than the key itself are not the schema's to state.
ordered_json with_all_defaults(json document, const ordered_json &schema) {
  for (json &illuminator : document.at("illuminators"))
    if (!illuminator.contains("pose"))
      illuminator["pose"] = {{"sensor", document.at("sensors").at(0).at("name")}};
  ordered_json setup = with_defaults(document, schema);
  for (ordered_json &illuminator : setup.at("illuminators"))
    if (illuminator.at("diodes").contains("file"))
      illuminator.erase("pattern");
  return setup;
}

ordered_json read_setup(const Place &root) {
  static const json schema = json::parse(setup_schema_text);
  static const ordered_json ordered_schema = ordered_json::parse(setup_schema_text);
  const std::string text = read_regular_file(root.file, max_setup_bytes, root);
  json document = parse_json(text, root.file, Comments::allowed);
  fill_presets(document);
  check_schema(document, schema, root.file);
  refuse_second_pattern(document, root);
  return with_all_defaults(document, ordered_schema);
}

FrameTimes frame_times_of(const ordered_json &frames, const Place &place) {
  FrameTimes times;
  times.start_s = frames.at("start_s");
  times.count = frames.at("count");
  if (frames.contains("rate_hz"))
    times.rate_hz = frames.at("rate_hz");
  else if (times.count > 1)
    throw input_error(place, "missing key \"rate_hz\", expected beside a count of more than 1");
  return times;
}

// `kind` says what the sensors or illuminators at `place` are.
template <class Named>
void refuse_doubled_names(const std::vector<Named> &all, const char *kind, const Place &place) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!names.insert(all[i].name).second)
      throw input_error(place / i / "name", fmt::format("expected a name that no other {} has, found {}",
                                                        kind, in_quotes(all[i].name)));
}

void warn_of_unseen_harmonics(Setup &setup) {
  for (const Sensor &sensor : setup.start.sensors) {
    const std::vector<double> &harmonics = sensor.waveform.harmonics;
    bool any = sensor.waveform.kind != Waveform::Kind::harmonics;
    for (std::size_t i = 0; i < harmonics.size(); ++i)
      any = any || (harmonics[i] != 0.0 && taps_show(i + 1, sensor.taps));
    if (!any)
      setup.warnings.push_back(
          fmt::format("sensor {}: none of its harmonics shows in {} taps (only number 1, {}, "
                      "{}, {} ... do): amplitudes will be 0",
                      sensor.name, sensor.taps, sensor.taps - 1, sensor.taps + 1, 2 * sensor.taps - 1));
  }
}

// Those of other cameras apart.
void set_illuminators(const ordered_json &illuminators, std::vector<Illuminator> all, const Place &place,
                      Instant &instant) {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (is_of_another(illuminators[i]))
      instant.others.push_back({illuminators[i].at("modulation_hz"), std::move(all[i])});
    else
      instant.illuminators.push_back(std::move(all[i]));
  if (instant.illuminators.empty())
    throw input_error(place, "expected at least one without modulation_hz, all are of other cameras");
}

void warn_of_unused_others(Setup &setup) {
  for (const Sensor &sensor : setup.start.sensors)
    if (!setup.start.others.empty() && !sensor.electronics)
      setup.warnings.push_back(fmt::format("sensor {}: illuminators with modulation_hz are left out, as only "
                                           "electronics see light of other cameras",
                                           sensor.name));
}

} // namespace

Setup load_setup(const std::filesystem::path &file) {
  const Place root{file};
  Setup setup;
  setup.file = file;
  setup.as_used = read_setup(root);
  const FilesRead files(file.parent_path());
  setup.backscatter =
      setup.as_used.at("backscatter") == "lambert" ? Backscatter::lambert : Backscatter::constant;
  setup.shadows = setup.as_used.at("shadows") == "auto" ? Shadows::automatic : Shadows::off;
  setup.bounces = bounces_of(setup.as_used, root);
  setup.frames = frame_times_of(setup.as_used.at("frames"), root / "frames");

  const std::filesystem::path scene_file = file.parent_path() / setup.as_used.at("scene").get<std::string>();
  GltfFile gltf = load_gltf(scene_file, root / "scene");
  GltfScene scene = gltf.at(setup.frames.start_s);
  const ordered_json &sensors = setup.as_used.at("sensors");
  for (std::size_t i = 0; i < sensors.size(); ++i)
    setup.start.sensors.push_back(sensor_of(sensors[i], root / "sensors" / i, scene));
  refuse_doubled_names(setup.start.sensors, "sensor", root / "sensors");
  const ordered_json &illuminators = setup.as_used.at("illuminators");
  std::vector<Illuminator> all =
      illuminators_of(illuminators, root / "illuminators", scene, setup.start.sensors, setup.warnings);
  refuse_doubled_names(all, "illuminator", root / "illuminators");
  set_illuminators(illuminators, std::move(all), root / "illuminators", setup.start);
  warn_of_unused_others(setup);

  warn_of_unseen_harmonics(setup);
  if (scene.scene.shape_count() == 0)
    setup.warnings.push_back(fmt::format(
        "{}: the scene has neither triangles nor points, nothing will be seen", scene_file.string()));
  if (setup.bounces.any())
    std::ranges::copy(bounce_warnings(scene.scene, gltf), std::back_inserter(setup.warnings));
  setup.start.scene = std::move(scene.scene);
  if (gltf.moves())
    setup.motion = std::make_shared<const Motion>(std::move(gltf), setup.as_used, root);
  setup.inputs = files.list();
  return setup;
}

Instant Setup::at(double time_s) const { return motion ? motion->at(time_s, start) : start; }

} // namespace pmdsim
