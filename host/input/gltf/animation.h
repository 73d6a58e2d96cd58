#pragma once
// glTF animations: how translation, rotation and scale of a file's nodes change over time.
// All animations of a file play at once, t = 0 s being their time 0, as the parts of one clip: so Blender
// writes a scene's objects. Two animations of the same property of the same node are refused.

#include "host/input/file/input_error.h"
#include "host/input/gltf/nodes.h"

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace tinygltf {
class Model;
}

namespace pmdsim {

enum class Interpolation { step, linear, cubic_spline };

// A value over time, glTF 2.0, appendix C. Before the first key it is the first key's, after the last the
// last's.
struct Keyframes {
  Interpolation interpolation;
  std::vector<double> times_s;    // at least one, strictly increasing
  std::vector<glm::dvec4> values; // one a key; three for a cubic spline: in-tangent, value, out-tangent
};

enum class AnimatedProperty { translation, rotation, scale };

struct AnimationChannel {
  std::size_t node; // its place in the list of the active scene's nodes
  AnimatedProperty property;
  std::size_t keyframes; // in Animation::keyframes
};

// Plain data. Channels that target nodes outside the active scene are checked and left out.
struct Animation {
  std::vector<Keyframes> keyframes;
  std::vector<AnimationChannel> channels;

  // Whether any value changes.
  bool moves() const;
  // Puts the animated properties of `nodes`, the list that the channels refer to, to their values.
  void apply(double time_s, std::vector<SceneNode> &nodes) const;
};

// `nodes` is the active scene's. Throws Error (input).
Animation read_animation(const tinygltf::Model &model, const std::vector<SceneNode> &nodes,
                         const Place &root);

} // namespace pmdsim
