#include "host/input/gltf/animation.h"

#include "host/input/gltf/data/accessor.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <optional>
#include <string>
#include <tiny_gltf.h>
#include <tuple>

namespace pmdsim {
namespace {

constexpr std::size_t max_keys = std::size_t{1} << 24; // of a file's samplers together

// Where a time lies among the keys.
struct KeySpan {
  std::size_t key; // the one before, or the first
  double fraction; // of the way to the next, 0 to 1; 0 outside the keys
  double length_s; // from the key to the next; 0 outside
};

KeySpan span_at(const std::vector<double> &times_s, double time_s) {
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin())
    return {0, 0.0, 0.0};
  const auto key = static_cast<std::size_t>(after - times_s.begin()) - 1;
  if (after == times_s.end())
    return {key, 0.0, 0.0};
  const double length_s = *after - times_s[key];
  return {key, (time_s - times_s[key]) / length_s, length_s};
}

glm::dvec4 key_value(const Keyframes &keyframes, std::size_t key) {
  return keyframes.values[keyframes.interpolation == Interpolation::cubic_spline ? 3 * key + 1 : key];
}

// The file's tangents are per second and scaled by the time between the keys.
glm::dvec4 spline_at(const std::vector<glm::dvec4> &values, const KeySpan &span) {
  const double t = span.fraction, t2 = t * t, t3 = t2 * t;
  const std::size_t from = 3 * span.key, to = from + 3;
  return (2.0 * t3 - 3.0 * t2 + 1.0) * values[from + 1] +
         span.length_s * (t3 - 2.0 * t2 + t) * values[from + 2] + (-2.0 * t3 + 3.0 * t2) * values[to + 1] +
         span.length_s * (t3 - t2) * values[to];
}

glm::dquat quaternion(const glm::dvec4 &xyzw) { return {xyzw.w, xyzw.x, xyzw.y, xyzw.z}; }

glm::dvec3 vector_at(const Keyframes &keyframes, double time_s) {
  const KeySpan span = span_at(keyframes.times_s, time_s);
  if (span.fraction == 0.0 || keyframes.interpolation == Interpolation::step)
    return key_value(keyframes, span.key);
  if (keyframes.interpolation == Interpolation::cubic_spline)
    return spline_at(keyframes.values, span);
  return glm::mix(keyframes.values[span.key], keyframes.values[span.key + 1], span.fraction);
}

// Values are quaternions x, y, z, w; linear interpolation goes along the great circle, the shorter way. The
// result has unit length; where a cubic spline runs through zero it is the key before.
glm::dquat rotation_at(const Keyframes &keyframes, double time_s) {
  const KeySpan span = span_at(keyframes.times_s, time_s);
  const glm::dquat before = glm::normalize(quaternion(key_value(keyframes, span.key)));
  if (span.fraction == 0.0 || keyframes.interpolation == Interpolation::step)
    return before;
  if (keyframes.interpolation == Interpolation::linear)
    return glm::normalize(glm::slerp(before, quaternion(keyframes.values[span.key + 1]), span.fraction));
  const glm::dquat spline = quaternion(spline_at(keyframes.values, span));
  const double length = glm::length(spline);
  return length > 0.0 ? spline / length : before;
}

bool changes(const Keyframes &keyframes) {
  const std::size_t keys = keyframes.times_s.size();
  for (std::size_t key = 1; key < keys; ++key) {
    if (key_value(keyframes, key) != key_value(keyframes, 0))
      return true;
    if (keyframes.interpolation == Interpolation::cubic_spline &&
        (keyframes.values[3 * key - 1] != glm::dvec4(0.0) || keyframes.values[3 * key] != glm::dvec4(0.0)))
      return true;
  }
  return false;
}

Interpolation interpolation_of(const std::string &name) {
  if (name == "STEP")
    return Interpolation::step;
  return name == "LINEAR" ? Interpolation::linear : Interpolation::cubic_spline;
}

AnimatedProperty property_of(const std::string &path) {
  if (path == "translation")
    return AnimatedProperty::translation;
  return path == "rotation" ? AnimatedProperty::rotation : AnimatedProperty::scale;
}

std::vector<double> read_times_s(const tinygltf::Model &model, std::size_t accessor, const Place &root) {
  const Place place = root / "accessors" / accessor;
  if (model.accessors[accessor].componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
    throw input_error(place / "componentType", "expected 5126 (float) for an animation's times");
  std::vector<double> times_s;
  for (const glm::dvec4 &time : read_vectors(model, accessor, 1, root)) {
    if (time.x < 0.0 || (!times_s.empty() && time.x <= times_s.back()))
      throw input_error(
          place, fmt::format("element {} is {} s, expected times from 0 s on, each after the one before",
                             times_s.size(), time.x));
    times_s.push_back(time.x);
  }
  return times_s;
}

void check_value_type(const tinygltf::Accessor &accessor, bool is_rotation, const Place &place) {
  const bool is_float = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
  if (!is_float && !is_rotation)
    throw input_error(place / "componentType", "expected 5126 (float) for an animated translation or scale");
  if (!is_float && (!accessor.normalized || accessor.componentType > TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT))
    throw input_error(place / "componentType",
                      "expected floats or normalized integers of 8 or 16 bit for an animated rotation");
}

// The values of a spline stay as they are: it is made of them before it is normalised.
void check_rotations(Keyframes &keyframes, const Place &place) {
  const bool is_spline = keyframes.interpolation == Interpolation::cubic_spline;
  for (std::size_t key = 0; key < keyframes.times_s.size(); ++key) {
    const double length = glm::length(key_value(keyframes, key));
    if (!(length > 1e-3))
      throw input_error(place,
                        fmt::format("element {} is no unit quaternion", is_spline ? 3 * key + 1 : key));
    if (!is_spline)
      keyframes.values[key] /= length;
  }
}

// Reads a file's samplers as its channels ask for them, each once.
class Samplers {
public:
  Samplers(const tinygltf::Model &model, const Place &root, std::vector<Keyframes> &keyframes)
      : model_(model), root_(root), keyframes_(keyframes) {}

  // Returns the place of its keyframes in `keyframes`.
  std::size_t read(std::size_t animation, std::size_t sampler, bool is_rotation) {
    const auto [known, is_new] = read_.try_emplace({animation, sampler, is_rotation}, keyframes_.size());
    if (is_new)
      keyframes_.push_back(made(model_.animations[animation].samplers[sampler], is_rotation,
                                root_ / "animations" / animation / "samplers" / sampler));
    return known->second;
  }

private:
  Keyframes made(const tinygltf::AnimationSampler &sampler, bool is_rotation, const Place &place) {
    const auto input = static_cast<std::size_t>(sampler.input);
    const auto output = static_cast<std::size_t>(sampler.output);
    Keyframes result{interpolation_of(sampler.interpolation), {}, {}};
    check_counts(model_.accessors[input].count, model_.accessors[output].count, result.interpolation, place);
    const Place output_place = root_ / "accessors" / output;
    check_value_type(model_.accessors[output], is_rotation, output_place);
    result.times_s = read_times_s(model_, input, root_);
    result.values = read_vectors(model_, output, is_rotation ? 4 : 3, root_);
    if (is_rotation)
      check_rotations(result, output_place);
    return result;
  }

  void check_counts(std::size_t times, std::size_t values, Interpolation interpolation, const Place &place) {
    const std::size_t expected = interpolation == Interpolation::cubic_spline ? 3 * times : times;
    if (values != expected)
      throw input_error(place / "output",
                        fmt::format("has {} elements, expected {} for {} times", values, expected, times));
    key_count_ += values;
    if (key_count_ > max_keys)
      throw input_error(place, fmt::format("the animations have more than {} keys", max_keys));
  }

  const tinygltf::Model &model_;
  const Place &root_;
  std::vector<Keyframes> &keyframes_;
  std::map<std::tuple<std::size_t, std::size_t, bool>, std::size_t> read_;
  std::size_t key_count_ = 0;
};

} // namespace

bool Animation::moves() const {
  return std::ranges::any_of(
      channels, [&](const AnimationChannel &channel) { return changes(keyframes[channel.keyframes]); });
}

void Animation::apply(double time_s, std::vector<SceneNode> &nodes) const {
  for (const AnimationChannel &channel : channels) {
    NodeTransform &transform = nodes[channel.node].transform;
    const Keyframes &values = keyframes[channel.keyframes];
    if (channel.property == AnimatedProperty::rotation)
      transform.rotation = rotation_at(values, time_s);
    else if (channel.property == AnimatedProperty::translation)
      transform.translation_m = vector_at(values, time_s);
    else
      transform.scale = vector_at(values, time_s);
  }
}

Animation read_animation(const tinygltf::Model &model, const std::vector<SceneNode> &nodes,
                         const Place &root) {
  const std::vector<std::optional<std::size_t>> places = places_of_nodes(model, nodes);
  Animation result;
  Samplers samplers(model, root, result.keyframes);
  for (std::size_t i = 0; i < model.animations.size(); ++i)
    for (const tinygltf::AnimationChannel &channel : model.animations[i].channels) {
      if (channel.target_node < 0)
        continue;
      const AnimatedProperty property = property_of(channel.target_path);
      const std::size_t keyframes =
          samplers.read(i, static_cast<std::size_t>(channel.sampler), property == AnimatedProperty::rotation);
      if (const auto place = places[static_cast<std::size_t>(channel.target_node)])
        result.channels.push_back({*place, property, keyframes});
    }
  return result;
}

} // namespace pmdsim
