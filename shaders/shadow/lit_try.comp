#version 460
// Tries all candidates of a part on each of its samples and all diodes of the bundle: three planes through the sample and one
// of the candidate's own decide about a diode.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/lit_decide.glsl"

layout(local_size_x_id = constant_lanes) in;
layout(constant_id = constant_lanes) const uint lanes = 8;
layout(constant_id = constant_flat_bundles) const uint flat_bundles = 0;
const uint samples_per_lane = tile_samples / lanes;

void main() {
  // Before anything branches, so that lavapipe reads the diodes once for all lanes.
  vec3 diodes[diodes_per_bundle];
  [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
    diodes[d] = Bundles(constants.diodes).at.places[d].xyz;
  DiodeFrame frame = diode_frame();

  uint part = part_of_workgroup(constants.work, list_tried + constants.bundle, constants.part_count);
  if (part == no_part)
    return;
  PartSample samples[samples_per_lane];
  uint blocked[samples_per_lane]; // by a candidate, or because the diode is behind the sample's own surface; a bit each
  [[unroll]] for (uint s = 0; s < samples_per_lane; ++s) {
    samples[s] = part_sample(part, s * (tile_samples / samples_per_lane) + gl_LocalInvocationID.x, frame);
    blocked[s] = 0u;
    [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
      blocked[s] |= affine_at(samples[s].surface, diodes[d], flat_bundles != 0) > 0.0 ? 0u : 1u << d;
  }

  LitScene scene = LitScenes(constants.scene).at;
  Words candidates = Words(constants.candidates);
  uint first = part * candidate_words;
  uint count = candidates.at[first];
  for (uint k = 1; k <= count; ++k) {
    Occluder occluder = Occluders(scene.occluders).at[candidates.at[first + k]];
    [[unroll]] for (uint s = 0; s < samples_per_lane; ++s) {
      Cone cone = cone_of(occluder, samples[s].point, frame, scene.world_rounding);
      [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
        blocked[s] |= depth_in(cone, diodes[d], flat_bundles != 0) >= 0.0 ? 1u << d : 0u;
    }
  }

  [[unroll]] for (uint s = 0; s < samples_per_lane; ++s)
    if (samples[s].is_there)
      Words(constants.visibility).at[samples[s].i] = ~blocked[s];
}
