#version 460
// Traces a ray from each of a part's samples to a diode of the bundle: any occluder in between will do. A workgroup is a part
// and a diode. The first walk begins at the tree's root and may be too long; the parts of such rays are walked again, so many
// nodes at a time that no walk is.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "lit_decide.glsl"
#include "lit_walk.glsl"
#include "paint.glsl"

layout(local_size_x = tile_samples) in;
layout(constant_id = constant_lit_masked) const uint masked = 0;
layout(constant_id = constant_lit_again) const uint again = 0;

// Whether an occluder with holes is there where the way from the point to the diode meets it.
bool is_there(LitScene scene, Occluder occluder, LitPoint point, vec3 diode, DiodeFrame frame) {
  Real3 from = real3(point.hi, point.lo), normal = real3(occluder.plane_hi.xyz, occluder.plane_lo.xyz);
  Real3 way = subtract3(add3(real3(diode, vec3(0.0)), real3(frame.centre, vec3(0.0))), from);
  Real offset = real(occluder.plane_hi.w, occluder.plane_lo.w);
  Real along = divide(add(offset, negate(dot3(normal, from))), dot3(normal, way));
  return look_of(scene.shapes, scene.surfaces, occluder.id, add3(from, scale3(way, along))).is_there;
}

bool blocks(LitScene scene, Occluder occluder, LitPoint point, vec3 diode, DiodeFrame frame) {
  bool between = depth_in(cone_of(occluder, point, frame, scene.world_rounding), diode, false) >= 0.0;
  if (masked != 0 && between && occluder.may_be_absent != 0u)
    return is_there(scene, occluder, point, diode, frame);
  return between;
}

// Whether any occluder from `node` on stands in the way. Else `node` is where the walk ended.
bool is_blocked(LitScene scene, LitPoint point, vec3 diode, DiodeFrame frame, inout uint node) {
  vec3 rounding = 1.2e-7 * abs(point.hi);
  vec3 place = frame.centre + diode, place_rounding = 1.2e-7 * (abs(frame.centre) + abs(diode));
  Shaft ray = shaft_between(point.hi - rounding, point.hi + rounding, place - place_rounding, place + place_rounding);
  uint steps = 0u;
  bool blocked = false;
  while (!blocked && node < constants.last_node && steps < steps_per_walk) {
    uint last_step = again != 0 ? steps + 1u : steps_per_walk; // again: all rays step by step together
    uint index = next_occluder(scene.tree, ray, constants.last_node, last_step, node, steps);
    if (index != no_occluder)
      blocked = blocks(scene, Occluders(scene.occluders).at[index], point, diode, frame);
  }
  return blocked;
}

const uint walked_again = 0x80000000u;

// The part of the entry at `from` in the list of the traced ones has to be walked again; it is enough to say so once.
void walk_again(uint from) {
  Work work = Work(constants.work);
  uint entry = atomicOr(work.list[from], walked_again);
  if ((entry & walked_again) == 0u)
    work.list[walked_list(constants.part_count, constants.bundle) + atomicAdd(work.at.walked[constants.bundle].x, 1u)] =
        entry;
}

void main() {
  Work work = Work(constants.work);
  uint list = again != 0 ? walked_list(constants.part_count, constants.bundle)
                         : traced_list(constants.part_count, constants.bundle);
  uint entry = work.list[list + gl_WorkGroupID.x] & ~walked_again;
  DiodeFrame frame = diode_frame();
  PartSample at = part_sample(work.list[entry], gl_LocalInvocationID.x, frame);
  vec3 diode = Bundles(constants.diodes).at.places[gl_WorkGroupID.y].xyz;
  bool blocked = at.is_there && !(affine_at(at.surface, diode, false) > 0.0);
  if (at.is_there && !blocked) {
    uint node = constants.first_node;
    blocked = is_blocked(LitScenes(constants.scene).at, at.point, diode, frame, node);
    if (again == 0 && !blocked && node < constants.last_node)
      walk_again(list + gl_WorkGroupID.x);
  }
  if (blocked)
    atomicAnd(Words(constants.reached).at[at.i], ~(1u << gl_WorkGroupID.y));
}
