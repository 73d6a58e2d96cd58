#include "host/input/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>

namespace pmdsim {

using nlohmann::json;

namespace {

constexpr std::array<std::string_view, 3> implemented = {"KHR_mesh_quantization", "EXT_meshopt_compression",
                                                         "KHR_texture_transform"};

// What these add is nothing that is simulated: lights for pictures (ours come from the setup), shading that
// leaves the base colour as it is, glow and gloss upon it, other materials to choose from. They move and hide
// no geometry. Transmission and volumes are not among them, as they change what is seen.
constexpr std::array<std::string_view, 10> without_effect = {
    "KHR_lights_punctual",   "KHR_materials_anisotropy",  "KHR_materials_clearcoat",
    "KHR_materials_ior",     "KHR_materials_iridescence", "KHR_materials_emissive_strength",
    "KHR_materials_sheen",   "KHR_materials_specular",    "KHR_materials_unlit",
    "KHR_materials_variants"};

template <class List>
bool holds(const List &list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

} // namespace

void refuse_other_extensions(const json &document, const Place &root) {
  const json required = document.value("extensionsRequired", json::array());
  for (std::size_t i = 0; i < required.size(); ++i) {
    const auto &name = required[i].get_ref<const std::string &>();
    if (!holds(implemented, name) && !holds(without_effect, name))
      throw input_error(root / "extensionsRequired" / i,
                        fmt::format("extension {} is not supported", in_quotes(name)));
  }
}

} // namespace pmdsim
