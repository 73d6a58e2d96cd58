#version 460
// Looks from each sample of a part with too many candidates towards all diodes of the bundle at once: most see nothing in
// between. Of the others the part keeps a bit each, in the place of its candidates.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/lit_decide.glsl"
#include "shaders/shadow/lit_walk.glsl"

layout(local_size_x = tile_samples) in;

// Whether an affine function of Cone may be at least 0 for a diode of the bundle.
bool may_be_inside(vec4 f, vec3 extent) {
  float spread = dot(abs(f.xyz), extent);
  return f.w + spread + 1e-6 * (abs(f.w) + spread) >= 0.0;
}

bool may_block(LitScene scene, Occluder occluder, LitPoint point, DiodeFrame frame, vec3 extent) {
  Cone cone = cone_of(occluder, point, frame, scene.world_rounding);
  return may_be_inside(cone.ab, extent) && may_be_inside(cone.bc, extent) && may_be_inside(cone.ca, extent) &&
         may_be_inside(cone.beyond, extent);
}

bool is_blocked_perhaps(LitScene scene, LitPoint point, DiodeFrame frame, vec3 extent) {
  vec3 rounding = vec3(4e-7 * size_of(point.hi)), widened = extent + rounding + 4e-7 * (frame.reach + size_of(frame.centre));
  Shaft shaft = shaft_between(point.hi - rounding, point.hi + rounding, frame.centre - widened, frame.centre + widened);
  uint node = 0u, steps = 0u;
  bool perhaps = false;
  while (!perhaps && node < scene.nodes && steps < steps_per_walk) {
    uint index = next_occluder(scene.tree, shaft, scene.nodes, node, steps);
    if (index != no_occluder)
      perhaps = may_block(scene, Occluders(scene.occluders).at[index], point, frame, extent);
  }
  return perhaps || node < scene.nodes; // or the walk was too long
}

void main() {
  // Before anything branches, so that lavapipe reads the diodes once for all lanes.
  vec3 diodes[diodes_per_bundle];
  [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
    diodes[d] = Bundles(constants.diodes).at.places[d].xyz;
  DiodeFrame frame = diode_frame();
  vec3 extent = Bundles(constants.diodes).at.extent.xyz;

  uint part = part_of_workgroup(constants.work, list_traced + constants.bundle, constants.part_count);
  if (part == no_part)
    return;
  uint within = gl_LocalInvocationID.x;
  PartSample at = part_sample(part, within, frame);
  if (!at.is_there)
    return;
  uint reached = 0u;
  [[unroll]] for (uint d = 0; d < diodes_per_bundle; ++d)
    reached |= affine_at(at.surface, diodes[d], false) > 0.0 ? 1u << d : 0u;
  Words(constants.visibility).at[at.i] = reached;
  if (reached == 0u || !is_blocked_perhaps(LitScenes(constants.scene).at, at.point, frame, extent))
    return;
  if (part < constants.slots)
    atomicOr(Words(constants.candidates).at[part * candidate_words + within / 32u], 1u << within % 32u);
  append_once(constants.work, list_unclear + constants.bundle, constants.part_count, part, 2u * constants.bundle + 1u);
}
