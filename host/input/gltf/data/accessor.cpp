#include "host/input/gltf/data/accessor.h"

#include "host/input/gltf/data/elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <tiny_gltf.h>
#include <type_traits>

namespace pmdsim {

namespace {

static_assert(std::numeric_limits<float>::is_iec559 && sizeof(float) == 4);

bool has_components(const tinygltf::Accessor &accessor, int components) {
  return accessor.type == (components == 1 ? TINYGLTF_TYPE_SCALAR : components);
}

const char *vector_type(int components) {
  constexpr std::array names{"\"SCALAR\"", "\"VEC2\"", "\"VEC3\"", "\"VEC4\""};
  return names.at(static_cast<std::size_t>(components) - 1);
}

// A normalized integer, glTF 2.0, section 3.6.2.2: of the most negative ones two mean -1.
template <class T>
double number(T value, bool normalized) {
  const auto plain = static_cast<double>(value);
  if constexpr (std::is_integral_v<T>)
    return normalized ? std::max(-1.0, plain / static_cast<double>(std::numeric_limits<T>::max())) : plain;
  return plain;
}

double component(const Elements &elements, std::size_t index, int c, const tinygltf::Accessor &accessor) {
  const auto read = [&]<class T>(T) {
    T value;
    std::memcpy(&value, elements.at(index) + static_cast<std::size_t>(c) * sizeof(T), sizeof(T));
    return number(value, accessor.normalized);
  };
  switch (accessor.componentType) {
  case TINYGLTF_COMPONENT_TYPE_BYTE:
    return read(std::int8_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    return read(std::uint8_t{});
  case TINYGLTF_COMPONENT_TYPE_SHORT:
    return read(std::int16_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    return read(std::uint16_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    return read(std::uint32_t{});
  default:
    return read(float{});
  }
}

template <class T>
std::vector<std::uint32_t> checked_indices(const Elements &elements, std::size_t vertex_count,
                                           const Place &place) {
  std::vector<std::uint32_t> indices(elements.count());
  for (std::size_t i = 0; i < elements.count(); ++i) {
    T index;
    std::memcpy(&index, elements.at(i), sizeof index);
    if (index == std::numeric_limits<T>::max())
      throw input_error(place, fmt::format("element {} is {}, the primitive restart value", i, index));
    if (index >= vertex_count)
      throw input_error(
          place, fmt::format("element {} is vertex {}, expected one below {}", i, index, vertex_count));
    indices[i] = index;
  }
  return indices;
}

} // namespace

std::vector<glm::dvec4> read_vectors(const tinygltf::Model &model, std::size_t index, int components,
                                     const Place &root) {
  const Place place = root / "accessors" / index;
  const tinygltf::Accessor &accessor = model.accessors[index];
  if (!has_components(accessor, components))
    throw input_error(place / "type", fmt::format("expected {}", vector_type(components)));
  const Elements elements = checked_elements(model, accessor, place);
  std::vector<glm::dvec4> vectors(elements.count(), glm::dvec4(0.0));
  for (std::size_t i = 0; i < elements.count(); ++i)
    for (int c = 0; c < components; ++c) {
      const double value = component(elements, i, c, accessor);
      if (!std::isfinite(value))
        throw input_error(place, fmt::format("element {} is not finite", i));
      vectors[i][c] = value;
    }
  return vectors;
}

std::vector<glm::dmat4> read_matrices(const tinygltf::Model &model, std::size_t index, std::size_t count,
                                      const Place &root) {
  const Place place = root / "accessors" / index;
  const tinygltf::Accessor &accessor = model.accessors[index];
  if (accessor.type != TINYGLTF_TYPE_MAT4 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
    throw input_error(place / "type", "expected \"MAT4\" of floats");
  if (accessor.count < count)
    throw input_error(place / "count", fmt::format("expected at least {}, found {}", count, accessor.count));
  const Elements elements = checked_elements(model, accessor, place);
  std::vector<glm::dmat4> matrices(count);
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 16; ++c) {
      const double value = component(elements, i, c, accessor);
      if (!std::isfinite(value))
        throw input_error(place, fmt::format("element {} is not finite", i));
      matrices[i][c / 4][c % 4] = value;
    }
  return matrices;
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model &model, std::size_t index,
                                        std::size_t vertex_count, const Place &root) {
  const Place place = root / "accessors" / index;
  const tinygltf::Accessor &accessor = model.accessors[index];
  if (accessor.type != TINYGLTF_TYPE_SCALAR || accessor.normalized)
    throw input_error(place / "type", "expected \"SCALAR\", not normalized, for indices");
  const Elements elements = checked_elements(model, accessor, place);
  switch (accessor.componentType) {
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    return checked_indices<std::uint8_t>(elements, vertex_count, place);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    return checked_indices<std::uint16_t>(elements, vertex_count, place);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    return checked_indices<std::uint32_t>(elements, vertex_count, place);
  default:
    throw input_error(place / "componentType", "expected 5121, 5123 or 5125 for indices");
  }
}

} // namespace pmdsim
