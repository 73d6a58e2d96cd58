// shaders/interface.h is read by GLSL and by C++: both must lay its structs out alike. The offsets that the
// compiled shaders carry are compared with the compiler's.

#include "shaders/interface.h"
#include "spirv/accumulate_straight_fp64.h"
#include "spirv/points_fp64.h"
#include "spirv/resolve_fp64.h"
#include "spirv/visibility_frag.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <map>
#include <span>
#include <string>

namespace {

using namespace pmdsim::shader;

constexpr std::uint32_t op_name = 5, op_member_name = 6, op_member_decorate = 72, decoration_offset = 35;

// "Struct.member" to its byte offset, of every struct in a SPIR-V module (Khronos' SPIR-V specification,
// section 3).
std::map<std::string, std::uint32_t> offsets_in(std::span<const std::uint32_t> module) {
  std::map<std::uint32_t, std::string> structs;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> members;
  std::map<std::string, std::uint32_t> offsets;
  const auto text = [](const std::uint32_t *words) {
    return std::string(reinterpret_cast<const char *>(words));
  };
  for (std::size_t at = 5; at < module.size(); at += module[at] >> 16) {
    const std::uint32_t *word = &module[at];
    switch (*word & 0xffffu) {
    case op_name:
      structs[word[1]] = text(word + 2);
      break;
    case op_member_name:
      members[{word[1], word[2]}] = text(word + 3);
      break;
    case op_member_decorate:
      if (word[3] == decoration_offset)
        offsets[structs[word[1]] + "." + members[{word[1], word[2]}]] = word[4];
      break;
    default:
      break;
    }
  }
  return offsets;
}

#define CHECK_OFFSET(offsets, Struct, member)                                                                \
  do {                                                                                                       \
    INFO(#Struct "." #member);                                                                               \
    REQUIRE((offsets).contains(#Struct "." #member));                                                        \
    CHECK((offsets).at(#Struct "." #member) == offsetof(Struct, member));                                    \
  } while (false)

} // namespace

TEST_CASE("structs of the points and visibility passes") {
  const auto offsets = offsets_in(points_fp64_spirv);
  for (const auto &from : {offsets, offsets_in(visibility_frag_spirv)}) {
    CHECK_OFFSET(from, Strip, column);
    CHECK_OFFSET(from, Strip, row);
    CHECK_OFFSET(from, Strip, columns);
    CHECK_OFFSET(from, Strip, rows);
    CHECK_OFFSET(from, Strip, resolution_y);
    CHECK_OFFSET(from, Strip, resolution_x);
    CHECK_OFFSET(from, Strip, samples);
    CHECK_OFFSET(from, Strip, padded_pixels);
  }
  CHECK_OFFSET(offsets, PointsConstants, slope);
  CHECK_OFFSET(offsets, PointsConstants, tags);
  CHECK_OFFSET(offsets, PointsConstants, planes);
  CHECK_OFFSET(offsets, PointsConstants, position_hi);
  CHECK_OFFSET(offsets, PointsConstants, position_lo);
  CHECK_OFFSET(offsets, PointsConstants, surface);
  CHECK_OFFSET(offsets, PointsConstants, backscatter);
  CHECK_OFFSET(offsets, TrianglePlane, plane_hi);
  CHECK_OFFSET(offsets, TrianglePlane, plane_lo);
  CHECK_OFFSET(offsets, TrianglePlane, backscatter);
  CHECK_OFFSET(offsets, TrianglePlane, object);
  CHECK_OFFSET(offsets, TrianglePlane, along_min);
  CHECK_OFFSET(offsets, TrianglePlane, along_max);
}

TEST_CASE("structs of the accumulate pass") {
  const auto offsets = offsets_in(accumulate_straight_fp64_spirv);
  CHECK_OFFSET(offsets, AccumulateConstants, position_hi);
  CHECK_OFFSET(offsets, AccumulateConstants, position_lo);
  CHECK_OFFSET(offsets, AccumulateConstants, surface);
  CHECK_OFFSET(offsets, AccumulateConstants, backscatter);
  CHECK_OFFSET(offsets, AccumulateConstants, sum);
  CHECK_OFFSET(offsets, AccumulateConstants, diodes);
  CHECK_OFFSET(offsets, AccumulateConstants, reference_hi);
  CHECK_OFFSET(offsets, AccumulateConstants, reference_lo);
  CHECK_OFFSET(offsets, AccumulateConstants, tones);
  CHECK_OFFSET(offsets, AccumulateConstants, blocks);
  CHECK_OFFSET(offsets, AccumulateConstants, plane);
  CHECK_OFFSET(offsets, Tone, turns_per_m);
  CHECK_OFFSET(offsets, Tone, wavenumber);
  CHECK_OFFSET(offsets, GroupDiode, position);
  CHECK_OFFSET(offsets, GroupDiode, axis);
  CHECK_OFFSET(offsets, GroupDiode, intensity);
  CHECK_OFFSET(offsets, GroupDiode, order);
}

TEST_CASE("structs of the resolve pass") {
  const auto offsets = offsets_in(resolve_fp64_spirv);
  CHECK_OFFSET(offsets, ResolveConstants, position_hi);
  CHECK_OFFSET(offsets, ResolveConstants, position_lo);
  CHECK_OFFSET(offsets, ResolveConstants, sum);
  CHECK_OFFSET(offsets, ResolveConstants, tags);
  CHECK_OFFSET(offsets, ResolveConstants, planes);
  CHECK_OFFSET(offsets, ResolveConstants, channels);
  CHECK_OFFSET(offsets, ResolveConstants, harmonics);
  CHECK_OFFSET(offsets, ResolveConstants, turns_per_m);
  CHECK_OFFSET(offsets, ResolveConstants, ambiguity_m);
  CHECK_OFFSET(offsets, ResolveConstants, limits);
  CHECK_OFFSET(offsets, ResolveConstants, plane);
  CHECK_OFFSET(offsets, ResolveConstants, first_channel);
  CHECK_OFFSET(offsets, ResolveConstants, amplitude_scale);
  CHECK_OFFSET(offsets, ResolveConstants, columns);
  CHECK_OFFSET(offsets, ResolveConstants, samples);
  CHECK_OFFSET(offsets, ResolveConstants, padded_pixels);
  CHECK_OFFSET(offsets, ResolveConstants, pixels);
}
