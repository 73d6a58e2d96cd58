#include "host/input/gltf/mesh/attributes.h"

#include "host/input/gltf/data/accessor.h"

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <tiny_gltf.h>

namespace pmdsim {
namespace {

constexpr const char *quantization = "KHR_mesh_quantization";

bool has_quantization(const tinygltf::Model &model) {
  return std::ranges::count(model.extensionsUsed, quantization) > 0 ||
         std::ranges::count(model.extensionsRequired, quantization) > 0;
}

bool is_float(const tinygltf::Accessor &accessor) {
  return accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
}

// 8 or 16 bit.
bool is_short(const tinygltf::Accessor &accessor) {
  return accessor.componentType >= TINYGLTF_COMPONENT_TYPE_BYTE &&
         accessor.componentType <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
}

bool is_unsigned_short(const tinygltf::Accessor &accessor) {
  return accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
}

bool is_unsigned_fraction(const tinygltf::Accessor &accessor) {
  return accessor.normalized && is_unsigned_short(accessor);
}

// An attribute that has to be there; `needed_by` is added where it is not.
class Attribute {
public:
  Attribute(const GltfPrimitive &primitive, std::string name, const char *needed_by = "")
      : primitive_(primitive), name_(std::move(name)) {
    const auto found = primitive.data.attributes.find(name_);
    if (found == primitive.data.attributes.end())
      throw input_error(primitive.place / "attributes",
                        fmt::format("missing key \"{}\"{}", name_, needed_by));
    accessor_ = static_cast<std::size_t>(found->second);
  }

  std::size_t accessor() const { return accessor_; }
  const tinygltf::Accessor &data() const { return primitive_.model.accessors[accessor_]; }
  Place place() const { return Place{primitive_.place.file} / "accessors" / accessor_; }

  void check_type(bool is_expected, const char *expected) const {
    if (!is_expected)
      throw input_error(place() / "type", fmt::format("expected {} for {}", expected, name_));
  }

  void check_component(bool is_expected, const char *expected) const {
    if (!is_expected)
      throw input_error(place() / "componentType", fmt::format("expected {}", expected));
  }

  // glTF 2.0's own types (section 3.7.2.1), and with KHR_mesh_quantization any of 8 or 16 bit.
  void check_quantizable(bool is_core) const {
    if (is_core || (is_short(data()) && has_quantization(primitive_.model)))
      return;
    const char *condition = is_short(data()) ? " without the extension KHR_mesh_quantization" : "";
    throw input_error(place() / "componentType",
                      fmt::format("{}{} is not allowed for {}{}", data().normalized ? "normalized " : "",
                                  data().componentType, name_, condition));
  }

  void check_count() const {
    const std::size_t vertices = Attribute(primitive_, "POSITION").data().count;
    if (data().count != vertices)
      throw input_error(primitive_.place / "attributes" / name_,
                        fmt::format("has {} elements, POSITION has {}", data().count, vertices));
  }

  std::vector<glm::dvec4> read(int components) const {
    return read_vectors(primitive_.model, accessor_, components, Place{primitive_.place.file});
  }

private:
  const GltfPrimitive &primitive_;
  std::string name_;
  std::size_t accessor_;
};

} // namespace

std::vector<glm::dvec4> read_positions(const GltfPrimitive &primitive) {
  const Attribute attribute(primitive, "POSITION");
  attribute.check_type(attribute.data().type == TINYGLTF_TYPE_VEC3, "\"VEC3\"");
  attribute.check_quantizable(is_float(attribute.data()));
  return attribute.read(3);
}

std::vector<glm::vec4> read_colours(const GltfPrimitive &primitive) {
  if (!primitive.data.attributes.contains("COLOR_0"))
    return {};
  const Attribute attribute(primitive, "COLOR_0");
  const tinygltf::Accessor &accessor = attribute.data();
  const bool has_alpha = accessor.type == TINYGLTF_TYPE_VEC4;
  attribute.check_type(has_alpha || accessor.type == TINYGLTF_TYPE_VEC3, "\"VEC3\" or \"VEC4\"");
  attribute.check_count();
  attribute.check_component(is_float(accessor) || is_unsigned_fraction(accessor),
                            "5126, or normalized 5121 or 5123, for COLOR_0");
  std::vector<glm::vec4> colours;
  for (const glm::dvec4 &colour : attribute.read(has_alpha ? 4 : 3)) {
    const glm::dvec4 opaque(colour.r, colour.g, colour.b, has_alpha ? colour.a : 1.0);
    colours.emplace_back(glm::clamp(opaque, 0.0, 1.0)); // as glTF 2.0, section 3.7.2.1, has it
  }
  return colours;
}

std::vector<glm::dvec2> read_texture_coordinates(const GltfPrimitive &primitive, std::uint32_t set) {
  const Attribute attribute(primitive, fmt::format("TEXCOORD_{}", set),
                            ", which its material's texture needs");
  attribute.check_type(attribute.data().type == TINYGLTF_TYPE_VEC2, "\"VEC2\"");
  attribute.check_count();
  attribute.check_quantizable(is_float(attribute.data()) || is_unsigned_fraction(attribute.data()));
  const std::vector<glm::dvec4> coordinates = attribute.read(2);
  return {coordinates.begin(), coordinates.end()};
}

std::vector<double> read_radii(const GltfPrimitive &primitive) {
  if (!primitive.data.attributes.contains("_RADIUS"))
    return {};
  const Attribute attribute(primitive, "_RADIUS");
  attribute.check_type(attribute.data().type == TINYGLTF_TYPE_SCALAR, "\"SCALAR\"");
  attribute.check_count();
  std::vector<double> radii;
  for (const glm::dvec4 &vector : attribute.read(1)) {
    if (!(vector.x > 0.0))
      throw input_error(attribute.place(),
                        fmt::format("element {} is {}, expected a radius above 0", radii.size(), vector.x));
    radii.push_back(vector.x);
  }
  return radii;
}

std::vector<WeightSet> weight_sets(const GltfPrimitive &primitive) {
  const auto &attributes = primitive.data.attributes;
  std::vector<WeightSet> sets;
  for (std::size_t n = 0;; ++n) {
    const std::string joints_name = fmt::format("JOINTS_{}", n), weights_name = fmt::format("WEIGHTS_{}", n);
    if (n > 0 && !attributes.contains(joints_name) && !attributes.contains(weights_name))
      return sets;
    const Attribute joints(primitive, joints_name);
    joints.check_component(is_unsigned_short(joints.data()) && !joints.data().normalized,
                           "5121 or 5123, not normalized, for joints");
    joints.check_count();
    const Attribute weights(primitive, weights_name);
    weights.check_component(is_float(weights.data()) || is_unsigned_fraction(weights.data()),
                            "5126, or 5121 or 5123 normalized, for weights");
    weights.check_count();
    sets.push_back({joints.accessor(), weights.accessor()});
  }
}

bool is_quantized(const GltfPrimitive &primitive) {
  return !is_float(Attribute(primitive, "POSITION").data());
}

} // namespace pmdsim
