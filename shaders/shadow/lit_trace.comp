#version 460
// Traces a ray from each of a part's unclear samples to a diode of the bundle: any occluder in between will do. A workgroup is
// a part and a diode. The first walk begins at the tree's root and may be too long; the parts of such rays are walked again, so
// many nodes at a time that no walk is.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/lit_decide.glsl"
#include "shaders/shadow/lit_walk.glsl"
#include "shaders/view/surface_appearance.glsl"

layout(local_size_x = tile_samples) in;
layout(constant_id = constant_cutouts) const uint cutouts = 0;
layout(constant_id = constant_is_first) const uint is_first = 1;

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
  if (cutouts != 0 && between && occluder.may_be_absent != 0u)
    return is_there(scene, occluder, point, diode, frame);
  return between;
}

// What a walk comes to: an occluder in the way, or the node where it ended.
struct Walk {
  bool blocked;
  uint node;
};

// From the tree's root, `steps_per_walk` steps at most.
Walk walk_through(LitScene scene, LitPoint point, vec3 diode, DiodeFrame frame, Shaft ray) {
  Walk walk = Walk(false, 0u);
  uint steps = 0u;
  while (!walk.blocked && walk.node < scene.nodes && steps < steps_per_walk) {
    uint index = next_occluder(scene.tree, ray, scene.nodes, walk.node, steps);
    if (index != no_occluder)
      walk.blocked = blocks(scene, Occluders(scene.occluders).at[index], point, diode, frame);
  }
  return walk;
}

// The same between two nodes, in a single loop, which no other ray's steps can make longer.
bool is_blocked_between(uint first, uint last, LitScene scene, LitPoint point, vec3 diode, DiodeFrame frame, Shaft ray) {
  bool blocked = false;
  uint node = first;
  while (!blocked && node < last) {
    TreeNode box = Tree(scene.tree).at[node];
    bool met = may_meet(ray, box);
    if (met && box.occluder != no_occluder)
      blocked = blocks(scene, Occluders(scene.occluders).at[box.occluder], point, diode, frame);
    node = met ? node + 1u : box.skip;
  }
  return blocked;
}

// Wide enough that whatever `blocks` takes to be in between is met.
Shaft ray_of(LitPoint point, vec3 diode, DiodeFrame frame) {
  vec3 place = frame.centre + diode;
  vec3 rounding = vec3(4e-7 * size_of(point.hi)), place_rounding = rounding + 4e-7 * (frame.reach + size_of(frame.centre));
  return shaft_between(point.hi - rounding, point.hi + rounding, place - place_rounding, place + place_rounding);
}

// Whether lit_clear.comp left the sample open.
bool is_unclear(uint part, uint within) {
  return part >= constants.slots ||
         (Words(constants.candidates).at[part * candidate_words + within / 32u] & 1u << within % 32u) != 0u;
}

void main() {
  DiodeFrame frame = diode_frame();
  uint list = (is_first != 0 ? list_unclear : list_walked) + constants.bundle;
  uint part = part_of_workgroup(constants.work, list, constants.part_count);
  if (part == no_part)
    return;
  PartSample at = part_sample(part, gl_LocalInvocationID.x, frame);
  vec4 diode = Bundles(constants.diodes).at.places[gl_WorkGroupID.y];
  bool shines = diode.w != 0.0;
  if (!at.is_there || !shines || !is_unclear(part, gl_LocalInvocationID.x))
    return;
  bool blocked = !(affine_at(at.surface, diode.xyz, false) > 0.0);
  if (!blocked) {
    LitScene scene = LitScenes(constants.scene).at;
    Shaft ray = ray_of(at.point, diode.xyz, frame);
    if (is_first == 0) {
      blocked = is_blocked_between(constants.first_node, constants.last_node, scene, at.point, diode.xyz, frame, ray);
    } else {
      Walk walk = walk_through(scene, at.point, diode.xyz, frame, ray);
      blocked = walk.blocked;
      if (!blocked && walk.node < scene.nodes)
        append_once(constants.work, list_walked + constants.bundle, constants.part_count, part, 2u * constants.bundle + 2u);
    }
  }
  if (blocked)
    atomicAnd(Words(constants.visibility).at[at.i], ~(1u << gl_WorkGroupID.y));
}
