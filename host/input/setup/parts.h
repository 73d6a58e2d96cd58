#pragma once
// The parts of a setup: sensors and illuminators, where they are, and how they move. JSON that functions take
// has passed the schema and has its defaults filled in; `place` is where in the setup it stands.

#include "engine/model/bounces.h"
#include "engine/model/illuminator.h"
#include "engine/model/sensor.h"
#include "host/input/file/input_error.h"
#include "host/input/gltf/loader.h"
#include "host/input/setup/setup.h"
#include "host/input/setup/trajectory.h"

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// What poses refer to.
struct Surroundings {
  const GltfScene &scene;
  const Trajectories &trajectories;
  double time_s; // that all of it is at
};

// World from the frame (x right, y down, z forward) that `pose` gives: {"node"}, {"position_m", "look_at_m",
// "up"}, {"matrix"}, {"trajectory"}, or {"sensor"} for one of `sensors`. Scale and shear of a node's
// transform are taken out, its view direction is kept. Throws Error (input) at `place`: unknown node or
// sensor, a view or an up without a direction, a mirrored node or one outside the world, a matrix that is no
// rotation and translation.
Pose world_from_frame(const nlohmann::ordered_json &pose, const Place &place, const Surroundings &at,
                      const std::vector<Sensor> &sensors);

// The setup's /nodes: where nodes of the scene are put at a time. Throws Error (input).
std::vector<PlacedNode> placed_nodes(const nlohmann::ordered_json &setup, const Place &root,
                                     const Trajectories &trajectories, double time_s);

// The trajectories that the setup names. Throws Error (input).
Trajectories read_trajectories(const nlohmann::ordered_json &setup, const Place &root);

// What of the sensor at `place` is likely to be in another unit than was meant.
std::vector<Warning> unit_doubts(const Sensor &sensor, const Place &place);
// The same of the diodes of an illuminator; `place` is where their places stand: in the setup, or a file.
std::vector<Warning> unit_doubts(const std::vector<Diode> &diodes, const Place &place);

// An element of /sensors. Throws Error (input): also for a distortion that folds over inside the image and a
// chip that is not in front of the lens.
Sensor sensor_of(const nlohmann::ordered_json &sensor, const Place &place, const Surroundings &at);

// A sensor's /electronics; `sensor` has its resolution and frequencies already. Throws Error (input).
Electronics electronics_of(const nlohmann::ordered_json &electronics, const Place &place,
                           const Sensor &sensor);

// Fills in what presets say, in a document that may be anything.
void fill_presets(nlohmann::json &setup);

// Why a sensor's lens and chip can make no image, for people.
struct LensProblem {
  std::string key;         // of the sensor in a setup: "chip", "distortion" or "resolution"
  std::string expectation; // "expected ..."
};

// Nothing where every place of the image has a ray, no pixel sees too much of the scene and the chip's front
// is towards the lens.
std::optional<LensProblem> lens_problem(const Sensor &sensor);

// Whether an element of /illuminators belongs to another camera.
inline bool is_of_another(const nlohmann::ordered_json &illuminator) {
  return illuminator.contains("modulation_hz");
}

// The setup's /illuminators. At most 100,000 diodes in all. Appends to `warnings` what is odd about their
// diagrams. Throws Error (input).
std::vector<Illuminator> illuminators_of(const nlohmann::ordered_json &illuminators, const Place &place,
                                         const Surroundings &at, const std::vector<Sensor> &sensors,
                                         std::vector<Warning> &warnings);

// The setup's /bounces and /bounce_error. Throws Error (input): also where light that bounces meets another
// /backscatter than lambert.
Bounces bounces_of(const nlohmann::ordered_json &setup, const Place &root);

// What the scene has that light that bounces does not heed: points.
std::vector<Warning> bounce_warnings(const Scene &scene, const GltfFile &gltf);

// The setup's scene at a time, its nodes in their places. Throws Error (input).
using SceneAtTime = std::function<GltfScene(double time_s)>;

// How a setup's scene moves, and the sensors and illuminators with its nodes or along trajectories.
class Motion {
public:
  Motion(SceneAtTime scene, Trajectories trajectories, nlohmann::ordered_json setup, Place root);

  // `start` with everything in its place at `time_s`. Throws Error (input).
  Instant at(double time_s, const Instant &start) const;

private:
  Instant placed_at(double time_s, const Instant &start) const;

  SceneAtTime scene_;
  Trajectories trajectories_;
  nlohmann::ordered_json setup_;
  Place root_;
};

} // namespace pmdsim
