#pragma once
// Whether a glTF material shows more than a Lambert surface does, going by what real files say.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// Any of "metallic", "glossy" and "transmitting" that a material is; it need not have passed a schema, as
// nothing but words follows from it.
//
// Metallic: a metallicFactor above 0.5. glTF's default is 1, but many files leave it out and mean no metal;
// where it is left out a material counts as metallic with a metallicRoughnessTexture, or with a
// roughnessFactor below 0.5. Glossy: a roughnessFactor below 0.3. Transmitting: KHR_materials_transmission or
// KHR_materials_diffuse_transmission with a factor above 0, or KHR_materials_volume with a thickness above 0.
std::vector<std::string> gloss_of(const nlohmann::json &material);

} // namespace pmdsim
