// A scene's file, glTF or GLB, with all that lies in it: buffers, images, animations and skins.

#include "tests/fuzz/target.h"

#include "host/input/gltf/loader.h"

using namespace pmdsim;

FUZZ_TARGET(gltf) {
  const std::filesystem::path file = fuzz::write_file("scene.glb", fuzz::text_of(data, size));
  fuzz::accepts([&] {
    const GltfFile gltf = load_gltf(file, Place{"setup.json"} / "scene");
    for (const Warning &warning : gltf.warnings({"camera"})) {
      fuzz::check_line(warning.text);
      fuzz::check_line(warning.place);
    }
    static_cast<void>(gltf.moves());
    fuzz::accepts([&] { gltf.at(0.0, {{"absent", {}, Place{"setup.json"} / "nodes"}}); });
    for (const double time_s : {0.0, 0.25, -3.0, 1e9})
      fuzz::accepts([&] {
        const GltfScene scene = gltf.at(time_s);
        fuzz::check_line(absent_camera_text("camera", gltf.file(), scene.nodes));
        if (!scene.nodes.empty())
          static_cast<void>(gltf.at(time_s, {{scene.nodes.front().name, {}, Place{"setup.json"} / "nodes"}}));
      });
  });
  return 0;
}
