#pragma once
// How a setup's scene moves, and the sensors and illuminators with its nodes.

#include "host/input/gltf/loader.h"
#include "host/input/setup/setup.h"

#include <nlohmann/json.hpp>

namespace pmdsim {

class Motion {
public:
  // `setup` has its defaults filled in.
  Motion(GltfFile gltf, nlohmann::ordered_json setup, Place root);

  // `start` with everything in its place at `time_s`. Throws Error (input).
  Instant at(double time_s, const Instant &start) const;

private:
  Instant placed_at(double time_s, const Instant &start) const;

  GltfFile gltf_;
  nlohmann::ordered_json setup_;
  Place root_;
};

} // namespace pmdsim
