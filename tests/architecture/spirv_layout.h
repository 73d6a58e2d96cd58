#pragma once
// How the structs of a compiled shader lie in memory (Khronos' SPIR-V specification, section 3).

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <vector>

namespace pmdsim::test {

struct Member {
  std::string name;
  std::size_t offset;
  std::size_t bytes; // of an array: all its elements with what lies between them

  bool operator==(const Member &) const = default;
};

std::ostream &operator<<(std::ostream &out, const Member &member);

struct StructLayout {
  std::string name;
  std::vector<Member> members;
  std::size_t array_stride = 0; // of an array without end of these; 0 where there is none
};

// The structs with offsets in a SPIR-V module, but for the blocks that only wrap others.
std::vector<StructLayout> struct_layouts(std::span<const std::uint32_t> module);

} // namespace pmdsim::test
