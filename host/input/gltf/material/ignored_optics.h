#pragma once
// What a glTF material shows that a matt surface of its base colour does not, and that is not simulated,
// going by what real files say.

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace pmdsim {

struct IgnoredOptics {
  const char *code;                         // of warning_kinds
  bool (*is_shown)(const nlohmann::json &); // by a material, which need not have passed a schema
  const char *one, *many;                   // "is metallic", "are metallic"
  const char *instead;                      // what is simulated, and what helps
};

// A feature counts where it changes what a material looks like, not where its key stands with a value that
// leaves all as it is; docs/warnings.md, "What a glTF file asks for in vain", has the rules.
const std::vector<IgnoredOptics> &ignored_optics();

// The material with what its writer left out and meant, by the file's asset.generator: Blender's exporter
// leaves out a metallicFactor of 1, which other writers leave out where they mean no metal.
nlohmann::json as_meant(nlohmann::json material, std::string_view generator);

} // namespace pmdsim
