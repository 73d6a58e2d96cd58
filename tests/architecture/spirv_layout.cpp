#include "tests/architecture/spirv_layout.h"

#include <map>
#include <set>

namespace pmdsim::test {
namespace {

enum Op : std::uint32_t {
  op_name = 5,
  op_member_name = 6,
  op_type_int = 21,
  op_type_float = 22,
  op_type_vector = 23,
  op_type_array = 28,
  op_type_runtime_array = 29,
  op_type_struct = 30,
  op_constant = 43,
  op_decorate = 71,
  op_member_decorate = 72,
};
enum Decoration : std::uint32_t { block = 2, array_stride = 6, member_offset = 35 };

using Id = std::uint32_t;
using MemberId = std::pair<Id, std::uint32_t>;

std::string text(const std::uint32_t *words) { return reinterpret_cast<const char *>(words); }

// The parts of a module that bear on its structs.
struct Module {
  std::map<Id, std::string> names;
  std::map<MemberId, std::string> member_names;
  std::map<MemberId, std::size_t> offsets;
  std::map<Id, std::vector<Id>> members; // of a struct: their types
  std::map<Id, std::size_t> bytes;       // of a type
  std::map<Id, std::size_t> strides;     // of an array
  std::map<Id, Id> runtime_arrays;       // of an element's type
  std::map<Id, std::uint32_t> constants;
  std::set<Id> blocks;

  explicit Module(std::span<const std::uint32_t> words) {
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16)
      read(words.subspan(at, words[at] >> 16));
  }

private:
  void read(std::span<const std::uint32_t> word) {
    switch (word[0] & 0xffffu) {
    case op_name:
      names[word[1]] = text(&word[2]);
      break;
    case op_member_name:
      member_names[{word[1], word[2]}] = text(&word[3]);
      break;
    case op_constant:
      constants[word[2]] = word[3];
      break;
    case op_decorate:
      if (word[2] == array_stride)
        strides[word[1]] = word[3];
      else if (word[2] == block)
        blocks.insert(word[1]);
      break;
    case op_member_decorate:
      if (word[3] == member_offset)
        offsets[{word[1], word[2]}] = word[4];
      break;
    default:
      read_type(word);
    }
  }

  // Types are declared after their names and decorations, and before they are used.
  void read_type(std::span<const std::uint32_t> word) {
    switch (word[0] & 0xffffu) {
    case op_type_int:
    case op_type_float:
      bytes[word[1]] = word[2] / 8;
      break;
    case op_type_vector:
      bytes[word[1]] = bytes[word[2]] * word[3];
      break;
    case op_type_array:
      bytes[word[1]] = strides[word[1]] * constants[word[3]];
      break;
    case op_type_runtime_array:
      runtime_arrays[word[2]] = word[1];
      break;
    case op_type_struct:
      members[word[1]].assign(word.begin() + 2, word.end());
      bytes[word[1]] = end_of_last_member(word[1]);
      break;
    default:
      break;
    }
  }

  std::size_t end_of_last_member(Id id) {
    const std::vector<Id> &types = members[id];
    if (types.empty())
      return 0;
    return offsets[{id, static_cast<std::uint32_t>(types.size() - 1)}] + bytes[types.back()];
  }
};

} // namespace

std::ostream &operator<<(std::ostream &out, const Member &member) {
  return out << member.name << " at " << member.offset << ", " << member.bytes << " bytes";
}

std::vector<StructLayout> struct_layouts(std::span<const std::uint32_t> words) {
  const Module module(words);
  std::vector<StructLayout> layouts;
  for (const auto &[id, types] : module.members) {
    if (module.blocks.contains(id) || !module.offsets.contains({id, 0}))
      continue;
    StructLayout layout{module.names.at(id), {}};
    for (std::uint32_t k = 0; k < types.size(); ++k)
      layout.members.push_back(
          {module.member_names.at({id, k}), module.offsets.at({id, k}), module.bytes.at(types[k])});
    if (const auto array = module.runtime_arrays.find(id); array != module.runtime_arrays.end())
      layout.array_stride = module.strides.at(array->second);
    layouts.push_back(layout);
  }
  return layouts;
}

} // namespace pmdsim::test
