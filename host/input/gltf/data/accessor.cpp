#include "host/input/gltf/data/accessor.h"

#include "host/input/file/memory_request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <tiny_gltf.h>
#include <type_traits>
#include <utility>

namespace pmdsim {
namespace {

static_assert(std::numeric_limits<float>::is_iec559 && sizeof(float) == 4);

constexpr std::size_t max_elements = std::size_t{1} << 25;
// The limit of an accessor without a bufferView: its zeros take memory, but no bytes of the file.
constexpr std::size_t max_zero_elements = std::size_t{1} << 20;
constexpr std::array<unsigned char, 64> zeros{}; // as long as the largest element, a MAT4 of floats

std::size_t component_bytes(int component_type) {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)));
}

// The number at `bytes`. A normalized integer is that of glTF 2.0, section 3.6.2.2: the two most negative
// ones mean -1.
double number_at(const unsigned char *bytes, int component_type, bool normalized) {
  const auto read = [&]<class T>(T value) {
    std::memcpy(&value, bytes, sizeof value);
    const auto plain = static_cast<double>(value);
    if constexpr (std::is_integral_v<T>)
      return normalized ? std::max(-1.0, plain / static_cast<double>(std::numeric_limits<T>::max())) : plain;
    return plain;
  };
  switch (component_type) {
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

// Elements of a known size, a stride apart, all of them inside their buffer.
struct ElementRange {
  const unsigned char *first;
  std::size_t stride_bytes;
  std::size_t count;

  const unsigned char *at(std::size_t index) const { return first + index * stride_bytes; }
};

// Elements as a file states them.
struct Stated {
  int view;
  std::size_t byte_offset;
  std::size_t count;
  std::size_t element_bytes;
};

// byteLength and byteOffset are below 2^53, count below 2^32 and the stride below 2^8: nothing overflows.
ElementRange checked_range(const tinygltf::Model &model, const Stated &stated, const Place &place) {
  const auto view = static_cast<std::size_t>(stated.view);
  const auto bytes = bytes_of_view(model, view, Place{place.file});
  const std::size_t stated_stride = model.bufferViews[view].byteStride;
  const std::size_t stride_bytes = stated_stride == 0 ? stated.element_bytes : stated_stride;
  if (stride_bytes < stated.element_bytes)
    throw input_error(place,
                      fmt::format("elements of {} bytes lie {} apart", stated.element_bytes, stride_bytes));
  const std::size_t end = stated.byte_offset + stride_bytes * (stated.count - 1) + stated.element_bytes;
  if (end > bytes.size())
    throw input_error(place, fmt::format("{} elements end at byte {}, the bufferView has {}", stated.count,
                                         end, bytes.size()));
  return {bytes.data() + stated.byte_offset, stride_bytes, stated.count};
}

// An accessor's elements, those of its bufferView or zeros, and the sparse ones that replace some of them.
class Elements {
public:
  // They point into the model. Throws Error (input) at `place`, that of the accessor, or at the bufferView.
  Elements(const tinygltf::Model &model, const tinygltf::Accessor &accessor, const Place &place)
      : model_(model), accessor_(accessor), place_(place),
        component_bytes_(component_bytes(accessor.componentType)), dense_{zeros.data(), 0, accessor.count} {
    if (accessor.bufferView >= 0)
      dense_ = checked_range(
          model, {accessor.bufferView, accessor.byteOffset, accessor.count, element_bytes()}, place);
    else if (accessor.count > max_zero_elements)
      throw input_error(place / "count",
                        fmt::format("expected at most {} elements without a bufferView, found {}",
                                    max_zero_elements, accessor.count));
    if (accessor.count > max_elements)
      throw input_error(place / "count",
                        fmt::format("expected at most {} elements, found {}", max_elements, accessor.count));
    if (accessor.sparse.isSparse)
      add_sparse(place / "sparse");
  }

  std::size_t count() const { return dense_.count; }

  // Throws Error (input) where it is not finite.
  double component(std::size_t index, std::size_t c) const {
    const double value =
        number_at(at(index) + c * component_bytes_, accessor_.componentType, accessor_.normalized);
    if (!std::isfinite(value))
      throw input_error(place_, fmt::format("element {} is not finite", index));
    return value;
  }

private:
  std::size_t element_bytes() const {
    const auto components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_.type));
    return static_cast<std::size_t>(components) * component_bytes_;
  }

  const unsigned char *at(std::size_t index) const {
    const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), index);
    if (found == replaced_.end() || *found != index)
      return dense_.at(index);
    return replacements_.at(static_cast<std::size_t>(found - replaced_.begin()));
  }

  // glTF 2.0, section 5.1.6: the sparse parts' views must not define byteStride.
  template <class Part>
  ElementRange sparse_range(const Part &part, std::size_t bytes, const Place &place) const {
    if (model_.bufferViews[static_cast<std::size_t>(part.bufferView)].byteStride != 0)
      throw input_error(place / "bufferView",
                        fmt::format("bufferView {} has a byteStride, expected none", part.bufferView));
    return checked_range(model_,
                         {part.bufferView, static_cast<std::size_t>(part.byteOffset),
                          static_cast<std::size_t>(accessor_.sparse.count), bytes},
                         place);
  }

  void add_sparse(const Place &place) {
    const auto &indices = accessor_.sparse.indices;
    if (static_cast<std::size_t>(accessor_.sparse.count) > accessor_.count)
      throw input_error(
          place / "count",
          fmt::format("expected at most {}, as many as the accessor's elements", accessor_.count));
    const Place at_indices = place / "indices";
    const ElementRange listed = sparse_range(indices, component_bytes(indices.componentType), at_indices);
    replacements_ = sparse_range(accessor_.sparse.values, element_bytes(), place / "values");
    for (std::size_t i = 0; i < listed.count; ++i) {
      const auto index = static_cast<std::uint32_t>(number_at(listed.at(i), indices.componentType, false));
      if (index >= accessor_.count)
        throw input_error(at_indices, fmt::format("index {} is {}, the accessor has {} elements", i, index,
                                                  accessor_.count));
      if (i > 0 && index <= replaced_.back())
        throw input_error(at_indices, fmt::format("index {} is {} after {}, expected them to increase", i,
                                                  index, replaced_.back()));
      replaced_.push_back(index);
    }
  }

  const tinygltf::Model &model_;
  const tinygltf::Accessor &accessor_;
  const Place &place_;
  std::size_t component_bytes_;
  ElementRange dense_;
  std::vector<std::uint32_t> replaced_; // ascending
  ElementRange replacements_{};         // as many
};

} // namespace

std::span<const unsigned char> bytes_of_view(const tinygltf::Model &model, std::size_t index,
                                             const Place &root) {
  const tinygltf::BufferView &view = model.bufferViews[index];
  const auto &buffer = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  const std::size_t end = view.byteOffset + view.byteLength; // both are below 2^53
  if (end > buffer.size())
    throw input_error(root / "bufferViews" / index,
                      fmt::format("ends at byte {}, its buffer has {}", end, buffer.size()));
  return std::span(buffer).subspan(view.byteOffset, view.byteLength);
}

std::vector<glm::dvec4> read_vectors(const tinygltf::Model &model, std::size_t index, int components,
                                     const Place &root) {
  constexpr std::array names{"\"SCALAR\"", "\"VEC2\"", "\"VEC3\"", "\"VEC4\""};
  const Place place = root / "accessors" / index;
  const tinygltf::Accessor &accessor = model.accessors[index];
  if (accessor.type != (components == 1 ? TINYGLTF_TYPE_SCALAR : components))
    throw input_error(place / "type",
                      fmt::format("expected {}", names.at(static_cast<std::size_t>(components) - 1)));
  const Elements elements(model, accessor, place);
  require_memory(elements.count() * sizeof(glm::dvec4), place, "its elements");
  std::vector<glm::dvec4> vectors(elements.count(), glm::dvec4(0.0));
  for (std::size_t i = 0; i < elements.count(); ++i)
    for (int c = 0; c < components; ++c)
      vectors[i][c] = elements.component(i, static_cast<std::size_t>(c));
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
  const Elements elements(model, accessor, place);
  require_memory(count * sizeof(glm::dmat4), place, "its elements");
  std::vector<glm::dmat4> matrices(count);
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 16; ++c)
      matrices[i][c / 4][c % 4] = elements.component(i, static_cast<std::size_t>(c));
  return matrices;
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model &model, std::size_t index,
                                        std::size_t vertex_count, const Place &root) {
  const Place place = root / "accessors" / index;
  const tinygltf::Accessor &accessor = model.accessors[index];
  if (accessor.type != TINYGLTF_TYPE_SCALAR || accessor.normalized)
    throw input_error(place / "type", "expected \"SCALAR\", not normalized, for indices");
  const Elements elements(model, accessor, place);
  using Type = std::pair<int, std::uint32_t>; // of a component, and its primitive restart value
  constexpr std::array types{Type{TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 0xff},
                             Type{TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 0xffff},
                             Type{TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 0xffffffff}};
  const auto type = std::ranges::find(types, accessor.componentType, &Type::first);
  if (type == types.end())
    throw input_error(place / "componentType", "expected 5121, 5123 or 5125 for indices");
  require_memory(elements.count() * sizeof(std::uint32_t), place, "its elements");
  std::vector<std::uint32_t> indices(elements.count());
  for (std::size_t i = 0; i < elements.count(); ++i) {
    indices[i] = static_cast<std::uint32_t>(elements.component(i, 0));
    if (indices[i] == type->second)
      throw input_error(place, fmt::format("element {} is {}, the primitive restart value", i, indices[i]));
    if (indices[i] >= vertex_count)
      throw input_error(
          place, fmt::format("element {} is vertex {}, expected one below {}", i, indices[i], vertex_count));
  }
  return indices;
}

} // namespace pmdsim
