#pragma once
// Where the elements of a glTF accessor lie. Every range is checked; nothing is assumed of what a file
// states.

#include "host/input/file/input_error.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tinygltf {
class Model;
struct Accessor;
} // namespace tinygltf

namespace pmdsim {

inline constexpr std::size_t max_accessor_elements = std::size_t{1} << 25;
// Of an accessor without a bufferView: its zeros take memory, but no bytes of the file.
inline constexpr std::size_t max_zero_elements = std::size_t{1} << 20;

// Elements of a known size, a stride apart, all of them inside their buffer.
struct ElementRange {
  const unsigned char *first;
  std::size_t stride_bytes;
  std::size_t count;

  const unsigned char *at(std::size_t index) const { return first + index * stride_bytes; }
};

// An accessor's elements, those of its bufferView or zeros, and the sparse ones that replace some of them.
struct Elements {
  ElementRange dense;
  std::vector<std::uint32_t> replaced; // ascending
  ElementRange replacements;           // as many

  std::size_t count() const { return dense.count; }
  const unsigned char *at(std::size_t index) const;
};

// They point into the model. Throws Error (input) at `place`, that of the accessor, or at the bufferView.
Elements checked_elements(const tinygltf::Model &model, const tinygltf::Accessor &accessor,
                          const Place &place);

} // namespace pmdsim
