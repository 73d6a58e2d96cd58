#version 460
// For each open part of a tile and each bundle of diodes: the occluders that may stand between them. Where there are few, they
// will be tried one by one; where there are many, or such as have holes, rays will be traced.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/lit_gather.glsl"

layout(constant_id = constant_tiled) const uint tiled = 0;

const uint too_many = largest_candidates + 1u;

// The surfaces of a part, and what is known of the bundle over them.
struct Own {
  Real3 normal[own_shapes]; // where there are fewer, the first again
  Real offset[own_shapes];
  bool all_known;
  float lowest_diode; // over any of them, m
  float farthest_m;   // a diode from a sample, at most
};

Own own_of(TilePart part, DiodeBox box) {
  Own own;
  own.all_known = part.own <= own_shapes;
  [[unroll]] for (uint k = 0; k < own_shapes; ++k) {
    TrianglePlane plane = Planes(LitScenes(constants.scene).at.planes).at[part.own_ids[k < part.own ? k : 0]];
    own.normal[k] = real3(plane.plane_hi.xyz, plane.plane_lo.xyz);
    own.offset[k] = real(plane.plane_hi.w, plane.plane_lo.w);
  }
  own.lowest_diode = lowest_diode(part, box);
  own.farthest_m = length(max(abs(box.high.xyz - part.low.xyz), abs(part.high.xyz - box.low.xyz)));
  return own;
}

// How far the occluder rises over any of the surfaces, m.
float rise_over(Own own, Occluder occluder, float world_rounding) {
  Real3 a = real3(occluder.a_hi.xyz, occluder.a_lo.xyz), b = real3(occluder.b_hi.xyz, occluder.b_lo.xyz),
        c = real3(occluder.c_hi.xyz, occluder.c_lo.xyz);
  float rise = 0.0;
  [[unroll]] for (uint k = 0; k < own_shapes; ++k) {
    Real down = negate(own.offset[k]);
    float highest = max(max(high(add(dot3(own.normal[k], a), down)), high(add(dot3(own.normal[k], b), down))),
                        high(add(dot3(own.normal[k], c), down)));
    float rounding = pair_rounding * abs(high(own.offset[k])) + world_rounding;
    rise = max(rise, highest - rounding);
  }
  return rise;
}

// Whether any of the tile's samples on other shapes lies within `reach_m` of the occluder, seen along its normal. Light from
// high above passes over what hardly rises, but for the samples right beside it: so triangles that are level with their
// neighbours to the last bit but one need not be tried.
bool is_beside(Occluder occluder, uint part_index, float reach_m) {
  vec3 a = occluder.a_hi.xyz, b = occluder.b_hi.xyz, c = occluder.c_hi.xyz, normal = occluder.plane_hi.xyz;
  vec3 from_ab = normalize(cross(normal, b - a)), from_bc = normalize(cross(normal, c - b)),
       from_ca = normalize(cross(normal, a - c));
  bool beside = false;
  uint asked = 0u;
  for (uint within = 0; within < tile_samples; ++within, ++asked) {
    TileSample at = tile_sample(constants.strip, part_index / parts_per_tile, within);
    vec3 point = high3(load_position(constants.position, at.i));
    bool other = at.is_there && shape_of(at, constants.strip, constants.ids, tiled != 0) != occluder.id;
    float inside_m = min(min(dot(from_ab, point - a), dot(from_bc, point - b)), dot(from_ca, point - c));
    float rounding = 1e-6 * (size_of(point) + size_of(a) + size_of(b) + size_of(c));
    beside = beside || (other && !(inside_m < -reach_m - rounding));
  }
  return beside || asked < tile_samples; // where lavapipe ended the loop (interface.h)
}

// Whether some diode of the box lies, seen from some sample of the part, on the inner side of the edge from `a` to `b`: the
// largest value that edge_plane's function can take, det(a - P, b - a, D - a) up to its sign.
bool may_be_inside(vec3 a, vec3 b, float side, TilePart part, DiodeBox box) {
  vec3 edge = b - a;
  vec3 points = a - 0.5 * (part.low.xyz + part.high.xyz), points_half = 0.5 * (part.high.xyz - part.low.xyz);
  vec3 diodes = 0.5 * (box.low.xyz + box.high.xyz) - a, diodes_half = 0.5 * (box.high.xyz - box.low.xyz);
  vec3 normal = cross(points, edge);
  vec3 both = points_half.yzx * diodes_half.zxy + points_half.zxy * diodes_half.yzx;
  float spread = dot(abs(normal), diodes_half) + dot(abs(cross(edge, diodes)), points_half) + dot(abs(edge), both);
  float p = size_of(points) + size_of(points_half), e = size_of(edge), d = size_of(diodes) + size_of(diodes_half);
  float corners = 2e-7 * (size_of(a) + size_of(b)); // rounded to float
  float rounding = 2e-6 * p * e * d + corners * (e * d + 2.0 * p * d + p * e);
  return side * dot(normal, diodes) + spread + rounding >= 0.0;
}

// The same for all three edges of an occluder that has the part wholly on one side.
bool may_be_behind(Occluder occluder, Range points, TilePart part, DiodeBox box) {
  if (occluder.body == no_body && points.low < 0.0 && points.high > 0.0)
    return true;
  float side = occluder.body != no_body || points.high <= 0.0 ? 1.0 : -1.0;
  vec3 a = occluder.a_hi.xyz, b = occluder.b_hi.xyz, c = occluder.c_hi.xyz;
  return may_be_inside(a, b, side, part, box) && may_be_inside(b, c, side, part, box) && may_be_inside(c, a, side, part, box);
}

bool may_block(Occluder occluder, uint part_index, TilePart part, DiodeBox box, Own own, float world_rounding,
               inout uint steps) {
  Range points = heights(occluder.plane_hi, part.low.xyz, part.high.xyz);
  if (!is_between(occluder.plane_hi, occluder.body, points, part, box) || !may_be_behind(occluder, points, part, box))
    return false;
  if (!own.all_known)
    return true;
  float rise = rise_over(own, occluder, world_rounding);
  if (rise <= 0.0)
    return false;
  float slope = rise / own.lowest_diode; // of the way to a diode that is spent below the occluder's top, at most
  if (own.lowest_diode <= 0.0 || slope > 1e-4)
    return true;
  steps += tile_samples / 2;
  return is_beside(occluder, part_index, slope * own.farthest_m);
}

// Stores the part's candidates and returns how many they are, or too_many.
uint gather(uint part_index, TilePart part, DiodeBox box, Own own) {
  LitScene scene = LitScenes(constants.scene).at;
  Shaft shaft = shaft_of(part, box);
  Words candidates = Words(constants.candidates);
  uint node = 0u, steps = 0u, count = 0u;
  while (node < scene.nodes && steps < steps_per_walk && count < too_many) {
    uint index = next_occluder(scene.tree, shaft, scene.nodes, node, steps);
    if (index != no_occluder) {
      Occluder occluder = Occluders(scene.occluders).at[index];
      if (may_block(occluder, part_index, part, box, own, scene.world_rounding, steps)) {
        count = occluder.may_be_absent != 0u ? too_many : count + 1u;
        if (count < too_many)
          candidates.at[part_index * candidate_words + count] = index;
      }
    }
  }
  return node < scene.nodes ? too_many : count;
}

void main() {
  uint entry = gl_GlobalInvocationID.x;
  if (entry >= Work(constants.work).at.list[list_open].count)
    return;
  uint part_index = entry_of(constants.work, list_open, constants.part_count, entry);
  TilePart part = Parts(constants.parts).at[part_index];
  DiodeBox box = DiodeBoxes(constants.boxes).at[1u + constants.bundle];
  Own own = own_of(part, box);
  bool has_slot = part_index < constants.slots;
  uint first = part_index * candidate_words;
  uint count = has_slot ? gather(part_index, part, box, own) : too_many;
  if (count == too_many) {
    append(constants.work, list_traced + constants.bundle, constants.part_count, part_index);
    if (has_slot) // for lit_clear.comp, a bit for each sample
      Words(constants.candidates).at[first] = Words(constants.candidates).at[first + 1u] = 0u;
  } else if (count > 0u || own.lowest_diode <= 0.0) {
    append(constants.work, list_tried + constants.bundle, constants.part_count, part_index);
    Words(constants.candidates).at[first] = count;
  }
}
