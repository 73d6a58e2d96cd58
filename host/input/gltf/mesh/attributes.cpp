#include "host/input/gltf/mesh/attributes.h"

#include "host/input/gltf/data/accessor.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <tiny_gltf.h>

namespace pmdsim {

namespace {

constexpr const char *quantization = "KHR_mesh_quantization";

struct Attribute {
  const tinygltf::Model &model;
  std::string name;
  std::size_t accessor;
  Place primitive;

  const tinygltf::Accessor &data() const { return model.accessors[accessor]; }
  Place place() const { return Place{primitive.file} / "accessors" / accessor; }
};

Attribute attribute_of(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                       const std::string &name, const Place &place) {
  return {model, name, static_cast<std::size_t>(primitive.attributes.at(name)), place};
}

bool has_quantization(const tinygltf::Model &model) {
  const auto lists_it = [](const std::vector<std::string> &names) {
    return std::find(names.begin(), names.end(), quantization) != names.end();
  };
  return lists_it(model.extensionsUsed) || lists_it(model.extensionsRequired);
}

bool is_float(const tinygltf::Accessor &accessor) {
  return accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
}

bool is_short(const tinygltf::Accessor &accessor) {
  constexpr std::array types = {TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                                TINYGLTF_COMPONENT_TYPE_SHORT, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT};
  return std::find(types.begin(), types.end(), accessor.componentType) != types.end();
}

bool is_unsigned_fraction(const tinygltf::Accessor &accessor) {
  return accessor.normalized && (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                 accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

// glTF 2.0's own types (section 3.7.2.1), and with KHR_mesh_quantization any of 8 or 16 bit.
void check_quantizable(const Attribute &attribute, bool is_core) {
  if (is_core || (is_short(attribute.data()) && has_quantization(attribute.model)))
    return;
  const char *condition = is_short(attribute.data()) ? " without the extension KHR_mesh_quantization" : "";
  throw input_error(attribute.place() / "componentType",
                    fmt::format("{}{} is not allowed for {}{}",
                                attribute.data().normalized ? "normalized " : "",
                                attribute.data().componentType, attribute.name, condition));
}

std::vector<glm::dvec4> read(const Attribute &attribute, int components) {
  return read_vectors(attribute.model, attribute.accessor, components, Place{attribute.primitive.file});
}

void check_type(const Attribute &attribute, bool is_expected, const char *expected) {
  if (!is_expected)
    throw input_error(attribute.place() / "type",
                      fmt::format("expected {} for {}", expected, attribute.name));
}

void check_count(const Attribute &attribute, std::size_t vertex_count) {
  if (attribute.data().count != vertex_count)
    throw input_error(attribute.primitive / "attributes" / attribute.name,
                      fmt::format("has {} elements, POSITION has {}", attribute.data().count, vertex_count));
}

} // namespace

std::vector<glm::dvec4> read_positions(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                                       const Place &place) {
  if (!primitive.attributes.contains("POSITION"))
    throw input_error(place / "attributes", "missing key \"POSITION\"");
  const Attribute attribute = attribute_of(model, primitive, "POSITION", place);
  check_type(attribute, attribute.data().type == TINYGLTF_TYPE_VEC3, "\"VEC3\"");
  check_quantizable(attribute, is_float(attribute.data()));
  return read(attribute, 3);
}

std::vector<glm::vec4> read_colours(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                                    std::size_t vertex_count, const Place &place) {
  if (!primitive.attributes.contains("COLOR_0"))
    return {};
  const Attribute attribute = attribute_of(model, primitive, "COLOR_0", place);
  const tinygltf::Accessor &accessor = attribute.data();
  const bool has_alpha = accessor.type == TINYGLTF_TYPE_VEC4;
  check_type(attribute, has_alpha || accessor.type == TINYGLTF_TYPE_VEC3, "\"VEC3\" or \"VEC4\"");
  check_count(attribute, vertex_count);
  if (!is_float(accessor) && !is_unsigned_fraction(accessor))
    throw input_error(attribute.place() / "componentType",
                      "expected 5126, or normalized 5121 or 5123, for COLOR_0");
  std::vector<glm::vec4> colours;
  colours.reserve(vertex_count);
  for (const glm::dvec4 &colour : read(attribute, has_alpha ? 4 : 3)) {
    const glm::dvec4 opaque(colour.r, colour.g, colour.b, has_alpha ? colour.a : 1.0);
    colours.emplace_back(glm::clamp(opaque, 0.0, 1.0)); // as glTF 2.0, section 3.7.2.1, has it
  }
  return colours;
}

std::vector<glm::dvec2> read_texture_coordinates(const tinygltf::Model &model,
                                                 const tinygltf::Primitive &primitive, std::uint32_t set,
                                                 std::size_t vertex_count, const Place &place) {
  const std::string name = fmt::format("TEXCOORD_{}", set);
  if (!primitive.attributes.contains(name))
    throw input_error(place / "attributes",
                      fmt::format("missing key \"{}\", which its material's texture needs", name));
  const Attribute attribute = attribute_of(model, primitive, name, place);
  check_type(attribute, attribute.data().type == TINYGLTF_TYPE_VEC2, "\"VEC2\"");
  check_count(attribute, vertex_count);
  check_quantizable(attribute, is_float(attribute.data()) || is_unsigned_fraction(attribute.data()));
  std::vector<glm::dvec2> coordinates;
  coordinates.reserve(vertex_count);
  for (const glm::dvec4 &vector : read(attribute, 2))
    coordinates.emplace_back(vector);
  return coordinates;
}

std::vector<double> read_radii(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                               std::size_t vertex_count, const Place &place) {
  if (!primitive.attributes.contains("_RADIUS"))
    return {};
  const Attribute attribute = attribute_of(model, primitive, "_RADIUS", place);
  check_type(attribute, attribute.data().type == TINYGLTF_TYPE_SCALAR, "\"SCALAR\"");
  check_count(attribute, vertex_count);
  std::vector<double> radii;
  radii.reserve(vertex_count);
  for (const glm::dvec4 &vector : read(attribute, 1)) {
    if (!(vector.x > 0.0))
      throw input_error(attribute.place(),
                        fmt::format("element {} is {}, expected a radius above 0", radii.size(), vector.x));
    radii.push_back(vector.x);
  }
  return radii;
}

bool is_quantized(const tinygltf::Model &model, const tinygltf::Primitive &primitive) {
  return !is_float(model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))]);
}

} // namespace pmdsim
