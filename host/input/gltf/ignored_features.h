#pragma once
// What a glTF file asks for and is not simulated, so that nothing is ignored without a word.

#include "engine/model/warning.h"
#include "host/input/file/input_error.h"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// A node of the active scene that carries a camera or a light.
struct GltfCarrier {
  std::string node; // its name; empty: none that a pose could tell
  Place place;
};

struct IgnoredFeatures {
  std::vector<Warning> warnings; // one a feature, with how many of it there are
  std::vector<GltfCarrier> cameras, lights;
};

// Of a document that has passed check_references(), whose active scene has these nodes (indices into
// /nodes). What other scenes have, and what has no effect on a measurement, is not told.
IgnoredFeatures ignored_features(const nlohmann::json &document, const std::vector<std::size_t> &nodes,
                                 const Place &root);

// Of a file's, those that a setup leaves: its cameras where no pose is at any of them, and lights at whose
// nodes none is. `used` are the names of the nodes of poses.
std::vector<Warning> unused_carriers(const IgnoredFeatures &features, const std::vector<std::string> &used);

} // namespace pmdsim
