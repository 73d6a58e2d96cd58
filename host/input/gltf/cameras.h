#pragma once
// The cameras of a glTF file, whose views are shown beside a setup's own.

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace pmdsim {

struct GltfPerspective {
  double vertical_rad;                   // full angle, above 0 and below pi
  std::optional<double> width_to_height; // nothing: the image's
};

// A document's, beside its /cameras, which need not have passed a schema; nothing for one without a
// perspective.
std::vector<std::optional<GltfPerspective>> gltf_cameras(const nlohmann::json &document);

} // namespace pmdsim
