#include "host/input/setup/setup.h"

#include "host/input/gltf/loader.h"
#include "host/input/schema/schema_check.h"
#include "host/input/setup/extent.h"
#include "host/input/setup/free_pose.h"
#include "host/input/setup/parts.h"
#include "host/input/setup/plausibility.h"
#include "host/input/words/near_name.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <optional>
#include <set>

namespace pmdsim {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

void refuse_second_pattern(const json &document, const Place &root) {
  const json &illuminators = document.at("illuminators");
  for (std::size_t i = 0; i < illuminators.size(); ++i)
    if (illuminators[i].at("diodes").contains("file") && illuminators[i].contains("pattern"))
      throw input_error(root / "illuminators" / i / "pattern",
                        "expected none beside a diode file, which has its own; remove it (or by --set "
                        "illuminators/" +
                            std::to_string(i) + "/pattern=null)");
}

// Defaults that depend on more than the key itself are not the schema's to state.
ordered_json with_all_defaults(json document, const ordered_json &schema) {
  for (json &illuminator : document.at("illuminators"))
    if (!illuminator.contains("pose"))
      illuminator["pose"] = {{"sensor", document.at("sensors").at(0).at("name")}};
  ordered_json setup = with_defaults(document, schema);
  setup.erase("$schema"); // is for editors; the same run has it or not
  for (ordered_json &illuminator : setup.at("illuminators"))
    if (illuminator.at("diodes").contains("file"))
      illuminator.erase("pattern");
  if (setup.at("frames").contains("trajectory")) {
    setup.at("frames").erase("start_s");
    if (!document.at("frames").contains("count"))
      setup.at("frames").erase("count"); // it is the poses'
  }
  return setup;
}

// As every command but `correct` asks for it.
json schema_with_scene() {
  json schema = json::parse(setup_schema_text);
  schema.at("required").insert(schema.at("required").begin(), "scene");
  return schema;
}

ordered_json checked_setup(const SetupDocument &source, bool with_scene = true) {
  constexpr std::size_t failure_bytes = 8192; // as most keys have alternatives, which fail apart
  static const DocumentSchema any_schema(json::parse(setup_schema_text), failure_bytes),
      scene_schema(schema_with_scene(), failure_bytes);
  static const ordered_json ordered_schema = ordered_json::parse(setup_schema_text);
  check_extent(source.json, source.root());
  json document = source.json;
  fill_presets(document);
  (with_scene ? scene_schema : any_schema).check(document, source.root());
  refuse_second_pattern(document, source.root());
  return with_all_defaults(document, ordered_schema);
}

// The keys that say when frames are taken are all in vain beside a trajectory.
void check_frames(const SetupDocument &source, const Place &root) {
  const json frames = source.json.is_object() ? source.json.value("frames", json::object()) : json::object();
  if (frames.contains("trajectory") && (frames.contains("start_s") || frames.contains("rate_hz")))
    throw input_error(root / "frames",
                      "expected no start_s and no rate_hz beside a trajectory, whose poses say when "
                      "frames are taken");
}

FrameTimes frame_times_of(const ordered_json &frames, const Place &place, const Trajectories &trajectories) {
  FrameTimes times;
  if (frames.contains("trajectory")) {
    times.times_s = trajectories.at(frames.at("trajectory").get<std::string>())->times_s;
    times.start_s = times.times_s.front();
    times.count = static_cast<std::uint32_t>(times.times_s.size());
    if (frames.contains("count") && frames.at("count") != times.count)
      throw input_error(place / "count",
                        fmt::format("expected {}, one for each pose of the trajectory", times.count));
    return times;
  }
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

void warn_of_unseen_harmonics(const Place &sensors, Setup &setup) {
  for (std::size_t s = 0; s < setup.start.sensors.size(); ++s) {
    const Sensor &sensor = setup.start.sensors[s];
    const std::vector<double> &harmonics = sensor.waveform.harmonics;
    bool any = sensor.waveform.kind != Waveform::Kind::harmonics;
    for (std::size_t i = 0; i < harmonics.size(); ++i)
      any = any || (harmonics[i] != 0.0 && taps_show(i + 1, sensor.taps));
    if (!any)
      setup.warnings.push_back(input_warning(
          warning_code("unseen-harmonics"), sensors / s / "waveform",
          fmt::format("sensor {}: none of its harmonics shows in {} taps (only number 1, {}, "
                      "{}, {} ... do): amplitudes will be 0; take more taps or other harmonics",
                      sensor.name, sensor.taps, sensor.taps - 1, sensor.taps + 1, 2 * sensor.taps - 1)));
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

void warn_of_unused_others(const Place &sensors, Setup &setup) {
  for (std::size_t s = 0; s < setup.start.sensors.size(); ++s)
    if (const Sensor &sensor = setup.start.sensors[s]; !setup.start.others.empty() && !sensor.electronics)
      setup.warnings.push_back(
          input_warning(warning_code("other-light-unused"), sensors / s,
                        fmt::format("sensor {}: illuminators with modulation_hz are left out, as only "
                                    "electronics see light of other cameras; give the sensor electronics",
                                    sensor.name)));
}

// A scene's file, or what stands for it, and what moves in it.
struct SceneSource {
  std::filesystem::path file; // empty: the setup has no scene
  SceneAtTime at;
  const GltfFile *gltf; // null: it has no file
};

bool has_trajectory(const ordered_json &setup) {
  const auto follows = [](const ordered_json &placed) {
    bool any = false;
    for_each_trajectory(placed.at("pose"), {}, [&](const std::string &, const Place &) { any = true; });
    return any;
  };
  return std::ranges::any_of(setup.at("sensors"), follows) ||
         std::ranges::any_of(setup.at("illuminators"), follows) ||
         std::ranges::any_of(setup.at("nodes"), follows);
}

void set_sensors_and_illuminators(const Place &root, const Surroundings &at, Setup &setup) {
  const ordered_json &sensors = setup.as_used.at("sensors");
  for (std::size_t i = 0; i < sensors.size(); ++i)
    setup.start.sensors.push_back(sensor_of(sensors[i], root / "sensors" / i, at));
  refuse_doubled_names(setup.start.sensors, "sensor", root / "sensors");
  const ordered_json &illuminators = setup.as_used.at("illuminators");
  std::vector<Illuminator> all =
      illuminators_of(illuminators, root / "illuminators", at, setup.start.sensors, setup.warnings);
  refuse_doubled_names(all, "illuminator", root / "illuminators");
  set_illuminators(illuminators, std::move(all), root / "illuminators", setup.start);
}

// The nodes at which sensors and illuminators are.
std::vector<std::string> nodes_of_poses(const ordered_json &setup) {
  std::vector<std::string> names;
  for (const char *list : {"sensors", "illuminators"})
    for (const ordered_json &placed : setup.at(list)) {
      const ordered_json &pose = placed.at("pose"),
                         &first = pose.contains("chain") ? pose.at("chain").at(0) : pose;
      if (first.contains("node"))
        names.push_back(first.at("node").get<std::string>());
    }
  return names;
}

bool has_warning(const Setup &setup, std::string_view code) {
  return std::ranges::find(setup.warnings, code, &Warning::code) != setup.warnings.end();
}

void warn(const SceneSource &source, const Place &root, Setup &setup) {
  for (std::size_t i = 0; i < setup.start.sensors.size(); ++i)
    std::ranges::copy(unit_doubts(setup.start.sensors[i], root / "sensors" / i),
                      std::back_inserter(setup.warnings));
  std::ranges::copy(implausibilities(setup, root), std::back_inserter(setup.warnings));
  warn_of_unused_others(root / "sensors", setup);
  warn_of_unseen_harmonics(root / "sensors", setup);
  if (setup.start.scene.shape_count() == 0 && !source.file.empty())
    setup.warnings.push_back(
        input_warning(warning_code("empty-scene"), Place{source.file},
                      "the scene has neither triangles nor points, nothing will be seen; name another "
                      "scene, or give the file's active scene meshes"));
  const bool tells_of_cameras = has_warning(setup, "no-camera-node");
  if (source.gltf)
    std::ranges::copy_if(
        source.gltf->warnings(nodes_of_poses(setup.as_used)), std::back_inserter(setup.warnings),
        [&](const Warning &warning) { return warning.code != "gltf-camera" || !tells_of_cameras; });
  if (setup.bounces.any() && source.gltf)
    std::ranges::copy(bounce_warnings(setup.start.scene, *source.gltf), std::back_inserter(setup.warnings));
}

// A sensor at another node is likely at the wrong one where the scene has cameras.
void warn_of_no_cameras(const std::vector<NamedNode> &nodes, const Place &sensors, Setup &setup) {
  std::vector<std::string> cameras;
  for (const NamedNode &node : nodes)
    if (node.is_camera)
      cameras.push_back(node.name);
  const ordered_json &all = setup.as_used.at("sensors");
  for (std::size_t i = 0; i < all.size() && !cameras.empty(); ++i) {
    const std::string name = all.at(i).at("pose").value("node", "");
    if (!name.empty() && std::ranges::find(cameras, name) == cameras.end())
      setup.warnings.push_back(input_warning(warning_code("no-camera-node"), sensors / i / "pose" / "node",
                                             fmt::format("the node {} is no camera, while the scene has {}",
                                                         in_quotes(name), listed_names(cameras))));
  }
}

std::vector<std::optional<SceneCamera>> scene_cameras(const std::vector<NamedNode> &nodes,
                                                      const ordered_json &sensors) {
  std::vector<std::optional<SceneCamera>> cameras;
  for (const ordered_json &sensor : sensors) {
    const std::string name = sensor.at("pose").value("node", "");
    const auto node = std::ranges::find(nodes, name, &NamedNode::name);
    cameras.push_back(node != nodes.end() && node->camera ? std::optional(SceneCamera{name, *node->camera})
                                                          : std::nullopt);
  }
  return cameras;
}

// `setup` has its as_used and its frames; `scene` is that of the source at their start.
void fill(const SceneSource &source, GltfScene scene, const Place &root, Trajectories trajectories,
          Setup &setup) {
  setup.file = root.file;
  setup.backscatter =
      setup.as_used.at("backscatter") == "lambert" ? Backscatter::lambert : Backscatter::constant;
  setup.shadows = setup.as_used.at("shadows") == "auto" ? Shadows::automatic : Shadows::off;
  setup.bounces = bounces_of(setup.as_used, root);
  set_sensors_and_illuminators(root, {scene, trajectories, setup.frames.start_s}, setup);
  warn_of_no_cameras(scene.nodes, root / "sensors", setup);
  setup.cameras = scene_cameras(scene.nodes, setup.as_used.at("sensors"));
  setup.start.scene = std::move(scene.scene);
  warn(source, root, setup);
  if ((source.gltf && source.gltf->moves()) || has_trajectory(setup.as_used))
    setup.motion = std::make_shared<const Motion>(source.at, std::move(trajectories), setup.as_used, root);
  std::ranges::copy(light_left_behind(setup, root), std::back_inserter(setup.warnings));
}

constexpr const char *given_scene = "(given)"; // as the setup's "scene"

} // namespace

// A scene's file, and all files that were read for it.
struct KnownScene {
  GltfFile gltf;
  std::vector<FileRead> inputs;
};

struct SetupLoader::Files {
  std::map<std::filesystem::path, KnownScene> scenes;
};

SetupLoader::SetupLoader() : files_(std::make_unique<Files>()) {}
SetupLoader::~SetupLoader() = default;
SetupLoader::SetupLoader(SetupLoader &&) noexcept = default;
SetupLoader &SetupLoader::operator=(SetupLoader &&) noexcept = default;

Setup SetupLoader::load(const SetupDocument &document) {
  const Place root = document.root();
  const std::filesystem::path &folder = document.folder;
  check_frames(document, root);
  Setup setup;
  setup.as_used = checked_setup(document);
  const FilesRead beside_scene(folder);
  const Trajectories trajectories = read_trajectories(setup.as_used, root);
  setup.frames = frame_times_of(setup.as_used.at("frames"), root / "frames", trajectories);
  setup.as_used.at("frames")["count"] = setup.frames.count;

  const std::filesystem::path file = folder / setup.as_used.at("scene").get<std::string>();
  auto known = files_->scenes.find(file);
  std::optional<FilesRead> of_scene;
  if (known == files_->scenes.end())
    of_scene.emplace(folder);
  const GltfFile gltf = of_scene ? load_gltf(file, root / "scene", document.scene_files) : known->second.gltf;
  const auto at = [gltf, trajectories, root, used = setup.as_used](double time_s) {
    return gltf.at(time_s, placed_nodes(used, root, trajectories, time_s));
  };
  GltfScene scene = at(setup.frames.start_s); // which reads textures
  if (of_scene)
    known = files_->scenes.emplace(file, KnownScene{gltf, of_scene->list()}).first;
  of_scene.reset();
  fill({file, at, &gltf}, std::move(scene), root, trajectories, setup);
  setup.inputs = known->second.inputs;
  std::ranges::copy(beside_scene.list(), std::back_inserter(setup.inputs));
  return setup;
}

namespace {

// `setup` has its as_used; the scene has no nodes and does not move.
void fill_without_nodes(const SceneSource &source, const char *why, const Place &root, Setup &setup) {
  if (!setup.as_used.at("nodes").empty())
    throw input_error(root / "nodes", why);
  const Trajectories trajectories = read_trajectories(setup.as_used, root);
  setup.frames = frame_times_of(setup.as_used.at("frames"), root / "frames", trajectories);
  setup.as_used.at("frames")["count"] = setup.frames.count;
  fill(source, source.at(setup.frames.start_s), root, trajectories, setup);
}

} // namespace

Setup SetupLoader::load(const SetupDocument &document, const std::shared_ptr<const Scene> &given) {
  const Place root = document.root();
  check_frames(document, root);
  SetupDocument with_scene = document;
  if (with_scene.json.is_object() && with_scene.json.contains("scene"))
    throw input_error(root / "scene", "expected none, as a scene is given");
  if (with_scene.json.is_object())
    with_scene.json["scene"] = given_scene;
  Setup setup;
  setup.as_used = checked_setup(with_scene);
  const auto at = [given](double) { return GltfScene{given_scene, *given, {}}; };
  fill_without_nodes({given_scene, at, nullptr}, "expected none, as the scene that is given has no nodes",
                     root, setup);
  return setup;
}

Setup SetupLoader::load_without_scene(const SetupDocument &document) {
  const Place root = document.root();
  check_frames(document, root);
  Setup setup;
  setup.as_used = checked_setup(document, false);
  const FilesRead beside_scene(document.folder);
  const auto at = [](double) { return GltfScene{}; };
  fill_without_nodes({{}, at, nullptr}, "expected none, as the setup has no scene", root, setup);
  setup.inputs = beside_scene.list();
  return setup;
}

Setup load_setup(const std::filesystem::path &file) { return SetupLoader().load(read_setup_document(file)); }

Instant Setup::at(double time_s) const { return motion ? motion->at(time_s, start) : start; }

} // namespace pmdsim
