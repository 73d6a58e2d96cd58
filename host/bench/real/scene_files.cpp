#include "host/bench/real/scene_files.h"

#include "host/bench/sweep.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"
#include "host/output/scene/gltf_writer.h"

#include <fmt/format.h>
#include <numeric>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json setup_json(const Setup &setup, const std::string &scene) {
  const Sensor &sensor = setup.start.sensors.front();
  return {{"scene", scene},
          {"backscatter", "lambert"},
          {"shadows", "auto"},
          {"sensors",
           {{{"name", sensor.name},
             {"resolution", {sensor.resolution.x, sensor.resolution.y}},
             {"pixel_pitch_m", {sensor.pixel_pitch_m.x, sensor.pixel_pitch_m.y}},
             {"focal_length_m", sensor.focal_length_m},
             {"modulation_hz", sensor.modulation_hz}}}},
          {"illuminators",
           {{{"name", "ring"}, {"pose", {{"sensor", sensor.name}}}, {"diodes", {{"file", "diodes.csv"}}}}}}};
}

std::string diodes_csv(const Illuminator &illuminator) {
  std::string text = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n";
  for (const auto &[position_m, axis, intensity_w_sr, pattern, across] : illuminator.diodes)
    text += fmt::format("{},{},{},{},{},{},{},{}\n", position_m.x, position_m.y, position_m.z, axis.x, axis.y,
                        axis.z, intensity_w_sr, pattern.order);
  return text;
}

} // namespace

Setup setup_of_kind(const SceneKind &kind, std::uint32_t triangles, std::uint32_t columns) {
  Setup setup = paper_ring();
  setup.backscatter = Backscatter::lambert;
  setup.start.scene = kind.make(triangles);
  for (Diode &diode : setup.start.illuminators.front().diodes)
    diode.pattern = {Pattern::Kind::cosine, 3.0};
  Sensor &sensor = setup.start.sensors.front();
  sensor.resolution = glm::uvec2(columns);
  sensor.focal_length_m = sensor.pixel_pitch_m.x * columns / (2.0 * half_view_tangent);
  return setup;
}

SceneFiles write_scene_files(const std::filesystem::path &directory, const std::string &name,
                             const Setup &setup) {
  const Scene &scene = setup.start.scene;
  GltfNode whole;
  whole.surfaces.resize(scene.surfaces.size());
  std::iota(whole.surfaces.begin(), whole.surfaces.end(), 0u);
  OutputSet files(directory);
  const auto add = [&](const std::string &file, const std::string &text) {
    files.add(file, [&](OutputFile &output) { output.write(text); });
  };
  add_gltf(files, name, scene, {whole});
  add(name + ".json", json_text(setup_json(setup, name + ".gltf")));
  add("diodes.csv", diodes_csv(setup.start.illuminators.front()));
  files.publish();
  return {directory / (name + ".json"), directory / (name + ".gltf"), directory / "diodes.csv"};
}

} // namespace pmdsim
