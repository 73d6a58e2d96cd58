#include "host/start/new_setup.h"

#include "engine/model/error.h"
#include "host/input/schema/schema_check.h"
#include "host/input/words/folder_names.h"
#include "host/output/files/output_file.h"
#include "host/output/files/output_set.h"
#include "host/output/scene/gltf_writer.h"
#include "host/start/setup_text.h"

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <system_error>
#include <vector>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;

void refuse_what_is_there(const fs::path &folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found)
    return;
  if (!fs::is_directory(status))
    throw Error(ExitCode::output,
                fmt::format("{}: exists and is no folder, expected the name of a new one", folder.string()));
  const std::vector<std::string> names = names_in(folder, error);
  // What a killed program was writing does not count.
  if (error ||
      !std::ranges::all_of(names, [](const auto &name) { return name_of_temporary(name).has_value(); }))
    throw Error(ExitCode::output, fmt::format("{}: the folder is not empty, expected a new one, or --force "
                                              "to replace files of the same names",
                                              folder.string()));
}

// A node for each object, and the camera's with the light's below it, so that both move together.
std::vector<GltfNode> nodes_of(const StartScene &start, const StartView &view) {
  std::vector<GltfNode> nodes;
  for (std::uint32_t i = 0; i < start.scene.surfaces.size(); ++i)
    nodes.push_back({.name = start.scene.objects[i], .surfaces = {i}});
  nodes.push_back(
      {.name = camera_node,
       .position_m = start.camera_m,
       .rotation = start.world_from_camera,
       .camera = GltfCamera{view_rad(view).y, static_cast<double>(view.resolution.x) / view.resolution.y},
       .children = {{.name = light_node, .position_m = view.light_m}}});
  return nodes;
}

} // namespace

NewFiles write_new_setup(const NewSetup &wanted) {
  const StartKind &kind = *wanted.kind;
  if (!wanted.replaces)
    refuse_what_is_there(wanted.folder);
  const StartScene start = kind.make(wanted.sizes);
  OutputSet files(wanted.folder);
  const auto add = [&](const char *name, std::string_view text) {
    files.add(name, [&](OutputFile &output) { output.write(text); });
  };
  add(start_setup_file, setup_text(kind, wanted.sizes, start));
  add_gltf(files, start_scene, start.scene, nodes_of(start, kind.view));
  if (kind.view.has_table)
    add(start_diodes_file, diodes_text(kind.view));
  add(start_schema_file, setup_schema_text);
  files.publish();
  return {files.directory() / start_setup_file, files.directory() / fmt::format("{}.gltf", start_scene),
          files.paths()};
}

} // namespace pmdsim
