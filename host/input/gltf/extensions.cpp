#include "host/input/gltf/extensions.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <string>

namespace pmdsim {

using nlohmann::json;

namespace {

const GltfExtension *find(std::string_view name) {
  const auto &rows = gltf_extensions();
  const auto found = std::ranges::find(rows, name, &GltfExtension::name);
  return found == rows.end() ? nullptr : &*found;
}

} // namespace

const std::vector<GltfExtension> &gltf_extensions() {
  using enum GltfExtension::Use;
  static const std::vector<GltfExtension> rows{
      {"KHR_mesh_quantization", read}, // has no parts: attributes may have other types
      {"EXT_meshopt_compression", read, {{"bufferViews/*", "buffer", "buffers"}}},
      {"KHR_texture_transform", read},
      // These add nothing that is simulated: lights for pictures (ours come from the setup), shading that
      // leaves the base colour as it is, glow and gloss upon it, other materials to choose from. They move
      // and hide no geometry. Transmission and volumes are not among them, as they change what is seen.
      {"KHR_lights_punctual", without_effect},
      {"KHR_materials_anisotropy", without_effect},
      {"KHR_materials_clearcoat", without_effect},
      {"KHR_materials_ior", without_effect},
      {"KHR_materials_iridescence", without_effect},
      {"KHR_materials_emissive_strength", without_effect},
      {"KHR_materials_sheen", without_effect},
      {"KHR_materials_specular", without_effect},
      {"KHR_materials_unlit", without_effect},
      {"KHR_materials_variants", without_effect},
  };
  return rows;
}

const json *extension_part(const json &object, std::string_view name) {
  const GltfExtension *known = find(name);
  if (known == nullptr || known->use != GltfExtension::Use::read)
    throw std::logic_error(fmt::format("the extension {} is not one that is read", name));
  const auto extensions = object.find("extensions");
  if (extensions == object.end())
    return nullptr;
  const auto part = extensions->find(std::string(name));
  return part == extensions->end() ? nullptr : &*part;
}

std::string remedy_for(std::string_view extension) {
  if (extension == "KHR_draco_mesh_compression")
    return ": export without compression (Blender: Data, Compression off), or pack with meshopt";
  if (extension == "KHR_texture_basisu" || extension == "EXT_texture_webp" ||
      extension == "EXT_texture_avif" || extension == "MSFT_texture_dds")
    return ": export with PNG or JPEG textures";
  return "";
}

void refuse_other_extensions(const json &document, const Place &root) {
  const json required = document.value("extensionsRequired", json::array());
  for (std::size_t i = 0; i < required.size(); ++i) {
    const auto &name = required[i].get_ref<const std::string &>();
    if (find(name) == nullptr)
      throw input_error(root / "extensionsRequired" / i,
                        fmt::format("extension {} is not supported{}", in_quotes(name), remedy_for(name)));
  }
}

} // namespace pmdsim
