// The same as in accumulate.glsl where all samples are summed, each of one record: its point follows from its depth, and the
// backscatter joins in the demodulation. A lit wall that faces all diodes takes one load and, in a frame's only run, one store
// a sample, which lavapipe does lane by lane.
#ifndef PMDSIM_ACCUMULATE_DEPTHS_GLSL
#define PMDSIM_ACCUMULATE_DEPTHS_GLSL

#include "shaders/sampling/grid.glsl"
#include "shaders/shared/compensated.glsl"
#include "shaders/shared/constants.h"
#include "shaders/view/meet.glsl"

layout(push_constant, std430) uniform Constants { DepthSumConstants constants; };
layout(constant_id = constant_is_only) const uint is_only = 0;
layout(constant_id = constant_general_chip) const uint general_chip = 0;

#define DIAGRAM_VALUES constants.diagrams
#include "shaders/light/sum.glsl"

layout(constant_id = constant_block_list) const uint block_list = no_blocks;
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Blocks {
  WorkList at;
  uint list[];
};

// All samples, or those of a list of blocks. Where a block ends beyond its row, or a workgroup beyond the list, the last
// samples are done again.
uint sample_of_invocation() {
  if (block_list == no_blocks)
    return gl_GlobalInvocationID.x;
  Blocks blocks = Blocks(constants.blocks_of_list);
  uint group = gl_WorkGroupID.z * workgroups_per_row + gl_WorkGroupID.y;
  uint entry = group * (workgroup_size / block_samples) + gl_LocalInvocationID.x / block_samples;
  uint block = blocks.list[min(entry, blocks.at.count - 1u)];
  return block / block_samples + min(gl_LocalInvocationID.x % block_samples, block % block_samples);
}

// The block's diodes that reach sample i, a bit each.
uint visibility_of_block(uint i, uint block) {
  if (shadowed == 0)
    return 0u;
  uint first = block * diodes_per_block;
  return Words(constants.visibility).at[first / diodes_per_bundle * constants.plane + i] >> first % diodes_per_bundle;
}

// A moment where the host has summed the diodes, plane by plane.
float moment_of_run(uint i, uint k) { return Floats(constants.diodes).at[k * constants.plane + i]; }

// `ray` leads to the point, at its depth.
ReferencePath load_point(uint i, LightRun run, out Point point, out Real3 ray, out Real3 position) {
  uvec2 at = row_by_row(i, constants.grid.columns, constants.grid.inverse_columns);
  ray = ray_of(at, constants.grid, constants.chip, general_chip != 0);
  position = point_at_depth(ray, load_record_depth(constants.records, i));
  vec4 surface = vec4(0.0);
  if (backscatter_model != backscatter_flat) {
    // An invocation that only pads has no record.
    uint triangle = load_record_ids(constants.records, min(i, constants.samples - 1)).y;
    surface = load_vec4(constants.planes, 3 * triangle) * vec4(1.0, 1.0, 1.0, -1.0);
  }
  return see_point(position, surface, run, point);
}

ReferencePath load_point(uint i, LightRun run, out Point point) {
  Real3 ray, position;
  return load_point(i, run, point, ray, position);
}

float load_backscatter(uint i) { return 1.0; }

void add_to_plane(uint plane, uint i, float backscatter, vec2 value) {
  uint at = plane * constants.plane + i;
  if (is_only != 0) {
    store_words(constants.sum, at, floatBitsToUint(value));
  } else {
    // One pipeline for all runs: long ones take their time to compile.
    vec4 before = mix(load_vec4(constants.sum, at), vec4(0.0), bvec4(constants.is_first != 0));
    store_vec4(constants.sum, at, compensated_add(before, value));
  }
}

#endif
