// Simulators: their setups.

#include "host/environment.h"
#include "host/input/file/json_file.h"
#include "host/library/calls.h"
#include "host/library/mesh.h"
#include "host/library/objects.h"
#include "host/output/files/manifest.h"
#include "host/threads.h"

#include <fmt/format.h>
#include <string_view>

namespace pmdsim::library {
namespace {

// Relative paths stay as they are, whatever the process's directory is later.
SetupDocument settled(SetupDocument document, const SimulatorObject &simulator) {
  document.scene_files = simulator.scene_files;
  std::error_code error;
  if (const auto current = std::filesystem::current_path(error); !error)
    document.folder = current / document.folder;
  return document;
}

SetupDocument document_of(std::string_view text, const char *directory, const SimulatorObject &simulator) {
  SetupDocument document = parse_setup_document(text, setup_text);
  document.folder = directory ? directory : "";
  return settled(std::move(document), simulator);
}

std::string_view text_of(const char *text, std::size_t length) { return {&required(text, "text"), length}; }

nlohmann::ordered_json description_of(const SimulatorObject &simulator) {
  const Camera &camera = *simulator.session.camera();
  nlohmann::ordered_json json{{"device", camera.device()}, {"driver", camera.driver()}, {"setup", nullptr}};
  if (!simulator.session.has_setup())
    return json;
  const Setup &setup = simulator.session.setup();
  json["setup"] = setup.as_used;
  json["sensors"] = array_of(setup.start.sensors, [](const Sensor &sensor) { return sensor.name; });
  json["frames"] = setup.frames.count;
  json["objects"] = setup.start.scene.objects;
  json["warnings"] = array_of(setup.warnings, warning_json);
  return json;
}

} // namespace

Handles<pmdsim_simulator, SimulatorObject> &simulators() {
  static Handles<pmdsim_simulator, SimulatorObject> all;
  return all;
}

InCall::InCall(const pmdsim_simulator *handle) : object_(simulators().get(handle)) {
  if (!object_)
    throw bad_handle("simulator");
  lock_ = std::unique_lock(object_->in_call, std::try_to_lock);
  if (!lock_)
    throw Refusal{PMDSIM_BUSY, "the simulator is in another call, expected one call at a time"};
  object_->cancelled = false;
}

} // namespace pmdsim::library

using namespace pmdsim;
using namespace pmdsim::library;

pmdsim_status pmdsim_simulator_create(const char *device, pmdsim_simulator **simulator) {
  return guarded([&] {
    required(simulator, "simulator");
    settle_environment();
    settle_threads();
    *simulator = simulators().add(std::make_shared<SimulatorObject>(device ? device : ""));
  });
}

pmdsim_status pmdsim_simulator_destroy(pmdsim_simulator *simulator) {
  return guarded([&] {
    if (simulator && !simulators().take(simulator))
      throw bad_handle("simulator");
  });
}

pmdsim_status pmdsim_simulator_load(pmdsim_simulator *simulator, const char *file) {
  return guarded([&] {
    const InCall in(simulator);
    in->session.load(settled(read_setup_document(&required(file, "file")), *in));
  });
}

pmdsim_status pmdsim_simulator_load_text(pmdsim_simulator *simulator, const char *text, size_t length,
                                         const char *directory) {
  return guarded([&] {
    const InCall in(simulator);
    in->session.load(document_of(text_of(text, length), directory, *in));
  });
}

pmdsim_status pmdsim_simulator_load_mesh(pmdsim_simulator *simulator, const char *text, size_t length,
                                         const char *directory, const pmdsim_mesh *mesh) {
  return guarded([&] {
    const InCall in(simulator);
    const auto scene = std::make_shared<const Scene>(scene_of(struct_of(mesh, sizeof(pmdsim_mesh), "mesh")));
    in->session.load(document_of(text_of(text, length), directory, *in), scene);
  });
}

pmdsim_status pmdsim_simulator_set(pmdsim_simulator *simulator, const char *json) {
  return guarded([&] {
    const InCall in(simulator);
    if (!in->session.has_setup())
      throw bad_argument("the simulator has no setup that could be changed");
    in->session.set(parse_json(&required(json, "json"), changes_text, Comments::refused));
  });
}

pmdsim_status pmdsim_simulator_describe(pmdsim_simulator *simulator, const char **json) {
  return guarded([&] {
    required(json, "json");
    const InCall in(simulator);
    in->description = json_text(description_of(*in));
    *json = in->description.c_str();
  });
}

pmdsim_status pmdsim_simulator_cancel(pmdsim_simulator *simulator) {
  return guarded([&] {
    const auto object = simulators().get(simulator);
    if (!object)
      throw bad_handle("simulator");
    object->cancelled = true;
  });
}

pmdsim_status pmdsim_simulator_allow_outside(pmdsim_simulator *simulator, int allowed) {
  return guarded([&] {
    const InCall in(simulator);
    if (allowed != 0 && allowed != 1)
      throw bad_argument(fmt::format("allowed: expected 0 or 1, found {}", allowed));
    in->scene_files = allowed == 1 ? UriFiles::anywhere : UriFiles::beside;
  });
}
