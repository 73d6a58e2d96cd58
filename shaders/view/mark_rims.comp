#version 460
// Marks the fragments of a distorted block that are rim cells, so that a sample finds their candidates with what it has to
// load anyway.
// It has no Real.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/interface.h"

layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer RimCells { RimCell at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer WordPairs { uvec2 at[]; };

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { MarkRimsConstants constants; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= constants.count)
    return;
  RimCell cell = RimCells(constants.cells).at[i];
  WordPairs fragments = WordPairs(constants.fragments);
  uint hit = fragments.at[cell.fragment].x & fragment_hit;
  fragments.at[cell.fragment].x = hit + 2u * (1u + cell.first_candidate);
}
