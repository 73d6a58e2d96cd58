#include "host/input/gltf/data/elements.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <tiny_gltf.h>

namespace pmdsim {

namespace {

constexpr std::array<unsigned char, 64> zeros{}; // as long as the largest element, a MAT4 of floats

std::size_t component_bytes(int component_type) {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)));
}

std::size_t element_bytes(const tinygltf::Accessor &accessor) {
  const auto components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  return static_cast<std::size_t>(components) * component_bytes(accessor.componentType);
}

// Elements as a file states them.
struct Stated {
  int view;
  std::size_t byte_offset;
  std::size_t count;
  std::size_t element_bytes;
};

// byteLength and byteOffset are below 2^53, count below 2^32 and the stride below 2^8: nothing overflows.
ElementRange checked_range(const tinygltf::Model &model, const Stated &stated, const Place &place) {
  const auto view_index = static_cast<std::size_t>(stated.view);
  const tinygltf::BufferView &view = model.bufferViews[view_index];
  const auto &buffer = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset + view.byteLength > buffer.size())
    throw input_error(
        Place{place.file} / "bufferViews" / view_index,
        fmt::format("ends at byte {}, its buffer has {}", view.byteOffset + view.byteLength, buffer.size()));
  const std::size_t stride_bytes = view.byteStride == 0 ? stated.element_bytes : view.byteStride;
  if (stride_bytes < stated.element_bytes)
    throw input_error(place,
                      fmt::format("elements of {} bytes lie {} apart", stated.element_bytes, stride_bytes));
  const std::size_t end = stated.byte_offset + stride_bytes * (stated.count - 1) + stated.element_bytes;
  if (end > view.byteLength)
    throw input_error(place, fmt::format("{} elements end at byte {}, the bufferView has {}", stated.count,
                                         end, view.byteLength));
  return {buffer.data() + view.byteOffset + stated.byte_offset, stride_bytes, stated.count};
}

// glTF 2.0, section 5.1.6: of the sparse parts' views byteStride must not be defined.
ElementRange checked_packed_range(const tinygltf::Model &model, const Stated &stated, const Place &place) {
  const auto view_index = static_cast<std::size_t>(stated.view);
  if (model.bufferViews[view_index].byteStride != 0)
    throw input_error(place / "bufferView",
                      fmt::format("bufferView {} has a byteStride, expected none", view_index));
  return checked_range(model, stated, place);
}

std::uint32_t unsigned_at(const unsigned char *bytes, std::size_t size_bytes) {
  const auto read = [&]<class T>(T value) {
    std::memcpy(&value, bytes, sizeof value);
    return std::uint32_t{value};
  };
  return size_bytes == 1 ? read(std::uint8_t{}) : size_bytes == 2 ? read(std::uint16_t{}) : read(0u);
}

std::vector<std::uint32_t> checked_replaced(const ElementRange &range, std::size_t index_bytes,
                                            std::size_t element_count, const Place &place) {
  std::vector<std::uint32_t> replaced(range.count);
  for (std::size_t i = 0; i < range.count; ++i) {
    replaced[i] = unsigned_at(range.at(i), index_bytes);
    if (replaced[i] >= element_count)
      throw input_error(
          place, fmt::format("index {} is {}, the accessor has {} elements", i, replaced[i], element_count));
    if (i > 0 && replaced[i] <= replaced[i - 1])
      throw input_error(place, fmt::format("index {} is {} after {}, expected them to increase", i,
                                           replaced[i], replaced[i - 1]));
  }
  return replaced;
}

void add_sparse(const tinygltf::Model &model, const tinygltf::Accessor &accessor, const Place &place,
                Elements &elements) {
  const auto &sparse = accessor.sparse;
  const auto count = static_cast<std::size_t>(sparse.count);
  if (count > accessor.count)
    throw input_error(place / "count",
                      fmt::format("expected at most {}, as many as the accessor's elements", accessor.count));
  const std::size_t index_bytes = component_bytes(sparse.indices.componentType);
  const auto offset = [](int byte_offset) { return static_cast<std::size_t>(byte_offset); };
  const ElementRange indices = checked_packed_range(
      model, {sparse.indices.bufferView, offset(sparse.indices.byteOffset), count, index_bytes},
      place / "indices");
  elements.replacements = checked_packed_range(
      model, {sparse.values.bufferView, offset(sparse.values.byteOffset), count, element_bytes(accessor)},
      place / "values");
  elements.replaced = checked_replaced(indices, index_bytes, accessor.count, place / "indices");
}

} // namespace

const unsigned char *Elements::at(std::size_t index) const {
  const auto found = std::lower_bound(replaced.begin(), replaced.end(), index);
  if (found == replaced.end() || *found != index)
    return dense.at(index);
  return replacements.at(static_cast<std::size_t>(found - replaced.begin()));
}

Elements checked_elements(const tinygltf::Model &model, const tinygltf::Accessor &accessor,
                          const Place &place) {
  Elements elements{{zeros.data(), 0, accessor.count}, {}, {zeros.data(), 0, 0}};
  if (accessor.bufferView >= 0)
    elements.dense = checked_range(
        model, {accessor.bufferView, accessor.byteOffset, accessor.count, element_bytes(accessor)}, place);
  else if (accessor.count > max_zero_elements)
    throw input_error(place / "count",
                      fmt::format("expected at most {} elements without a bufferView, found {}",
                                  max_zero_elements, accessor.count));
  if (accessor.count > max_accessor_elements)
    throw input_error(place / "count", fmt::format("expected at most {} elements, found {}",
                                                   max_accessor_elements, accessor.count));
  if (accessor.sparse.isSparse)
    add_sparse(model, accessor, place / "sparse", elements);
  return elements;
}

} // namespace pmdsim
