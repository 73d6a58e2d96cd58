#version 460
// Tries all candidates of a part on each of its samples and all diodes of the bundle: three planes through the sample and one
// of the candidate's own decide about a diode.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "lit_decide.glsl"

layout(local_size_x_id = constant_lit_lanes) in;
layout(constant_id = constant_lit_samples) const uint samples_per_lane = 8;

void main() {
  // Before anything branches, so that lavapipe reads the diodes once for all lanes.
  vec3 diodes[diodes_per_bundle];
  [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
    diodes[d] = Bundles(constants.diodes).at.places[d].xyz;
  DiodeFrame frame = diode_frame();

  Work work = Work(constants.work);
  uint entry = work.list[tried_list(constants.part_count, constants.bundle) + gl_WorkGroupID.x];
  uint part = work.list[entry];
  PartSample samples[samples_per_lane];
  float depth[samples_per_lane][diodes_per_bundle]; // at least 0 behind a candidate, or behind the sample's own surface
  [[unroll]] for (uint s = 0; s < samples_per_lane; ++s) {
    samples[s] = part_sample(part, s * (tile_samples / samples_per_lane) + gl_LocalInvocationID.x, frame);
    [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
      depth[s][d] = -affine_at(samples[s].surface, diodes[d]);
  }

  LitScene scene = LitScenes(constants.scene).at;
  Words candidates = Words(constants.candidates);
  uint first = candidate_slot(entry, constants.bundles, constants.bundle) * slot_words;
  uint count = candidates.at[first];
  for (uint k = 1; k <= count; ++k) {
    Occluder occluder = Occluders(scene.occluders).at[candidates.at[first + k]];
    [[unroll]] for (uint s = 0; s < samples_per_lane; ++s) {
      Cone cone = cone_of(occluder, samples[s].point, frame, scene.world_rounding);
      [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
        depth[s][d] = max(depth[s][d], depth_in(cone, diodes[d]));
    }
  }

  [[unroll]] for (uint s = 0; s < samples_per_lane; ++s) {
    uint reached = 0u;
    [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
      reached |= depth[s][d] >= 0.0 ? 0u : 1u << d;
    if (samples[s].is_there)
      Words(constants.reached).at[samples[s].i] = reached;
  }
}
