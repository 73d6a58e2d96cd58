#version 460
// Tries all candidates of a part on each of its samples and all diodes of the bundle: three planes through the sample and one
// of the candidate's own decide about a diode.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "lit_decide.glsl"

void main() {
  // Before anything branches, so that lavapipe reads the diodes once for all lanes.
  vec3 diodes[diodes_per_bundle];
  [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
    diodes[d] = Vec4s(constants.diodes).at[d].xyz;

  Work work = Work(constants.work);
  uint entry = work.list[tried_list(constants.part_count, constants.bundle) + gl_WorkGroupID.x];
  uint part = work.list[entry];
  PartSample at = part_sample(part);

  float depth[diodes_per_bundle]; // at least 0 behind a candidate, or behind the sample's own surface
  [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
    depth[d] = -height_of_diode(at, diodes[d]);
  uvec2 occluders = LitScenes(constants.scene).at.occluders;
  Words candidates = Words(constants.candidates);
  uint first = candidate_slot(entry, constants.bundles, constants.bundle) * slot_words;
  uint count = candidates.at[first];
  for (uint k = 1; k <= count; ++k) {
    Cone cone = cone_of(Occluders(occluders).at[candidates.at[first + k]], at.point);
    [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
      depth[d] = max(depth[d], depth_in(cone, diodes[d]));
  }
  uint reached = 0u;
  [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
    reached |= depth[d] >= 0.0 ? 0u : 1u << d;
  if (at.is_there)
    Words(constants.reached).at[at.i] = reached;
}
