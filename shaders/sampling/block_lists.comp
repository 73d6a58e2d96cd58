#version 460
// Lists blocks of depth records by what there is to do for them. An invocation is a block.
// It has no Real.
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/shared/interface.h"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { BlockListConstants constants; };

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer RecordWords { uvec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer LitWords { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer BlockList {
  WorkList at;
  uint entries[];
};

const uint blocks_per_workgroup = workgroup_size / block_samples;

// Adds the entry of each invocation that `is_one`: one addition for all of a subgroup.
void append(uvec2 to, bool is_one, uint entry) {
  uint count = subgroupAdd(is_one ? 1u : 0u), before = subgroupExclusiveAdd(is_one ? 1u : 0u);
  if (count == 0u)
    return;
  BlockList list = BlockList(to);
  uint first = 0u;
  if (subgroupElect()) {
    first = atomicAdd(list.at.count, count);
    uint groups = (first + count + blocks_per_workgroup - 1u) / blocks_per_workgroup;
    atomicMax(list.at.groups_y, min(groups, workgroups_per_row));
    atomicMax(list.at.groups_z, (groups + workgroups_per_row - 1u) / workgroups_per_row);
  }
  first = subgroupMax(first);
  if (is_one)
    list.entries[first + before] = entry;
}

void main() {
  uint block = gl_GlobalInvocationID.x, row = block / constants.blocks_across;
  bool is_there = row < constants.rows;
  uint first = (block - row * constants.blocks_across) * block_samples;
  bool sees = false, shaded = false;
  [[unroll]] for (uint within = 0; within < block_samples; ++within) {
    uint i = min(row, constants.rows - 1u) * constants.columns + min(first + within, constants.columns - 1u);
    sees = sees || RecordWords(constants.records).at[i].x != 0u;
    shaded = shaded || LitWords(constants.lit).at[i] != constants.shining;
  }
  uint entry = (row * constants.columns + first) * block_samples + min(block_samples, constants.columns - first) - 1u;
  append(constants.lists[blocks_empty - blocks_lit], is_there && !sees, entry);
  append(constants.lists[blocks_shaded - blocks_lit], is_there && sees && shaded, entry);
  append(constants.lists[blocks_lit - blocks_lit], is_there && sees && !shaded, entry);
}
