#pragma once
// A good setup and its scene, for a test to change in one place.

#include "host/input/setup/setup.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/host/input/gltf/builder.h"
#include "tests/support/temporary_folder.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim::test {

struct SetupFixture {
  TemporaryFolder folder;
  nlohmann::json setup = nlohmann::json::parse(R"({
    "scene": "scene.gltf",
    "sensors": [{
      "name": "pmd",
      "resolution": [64, 48],
      "pixel_pitch_m": [45e-6, 40e-6],
      "focal_length_m": 0.01,
      "modulation_hz": [20e6]
    }],
    "illuminators": [{
      "name": "ring",
      "diodes": {"rings": [{"radius_m": 0.1, "count": 8}]}
    }]
  })");
  nlohmann::json scene = one_triangle();

  nlohmann::json &sensor() { return setup["sensors"][0]; }
  nlohmann::json &illuminator() { return setup["illuminators"][0]; }

  Setup load() const {
    folder.write("scene.gltf", scene.dump());
    return load_text(setup.dump());
  }
  Setup load_text(const std::string &text) const { return load_setup(folder.write("setup.json", text)); }

  std::string error() const {
    return input_error_of([&] { load(); });
  }
};

// The first illuminator's.
inline std::vector<Diode> diodes_of(const Setup &setup) { return setup.start.illuminators.at(0).diodes; }

inline double distance(const glm::dvec3 &a, const glm::dvec3 &b) { return glm::length(a - b); }

} // namespace pmdsim::test
