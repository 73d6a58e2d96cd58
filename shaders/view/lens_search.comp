#version 460
// The point of the scene that each sample sees through a lens with distortion: its ray follows from the inverse lens model,
// and meets the nearest of the surfaces that the fragment that it falls in and the eight around it see; or in a rim cell
// the nearest of all shapes there.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/buffers.glsl"
#include "shaders/sampling/chip.glsl"
#include "shaders/view/lens.glsl"
#include "shaders/view/points.glsl"
#include "shaders/shared/real.glsl"

layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Corners { TriangleCorners at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer RimCandidates { RimCandidate at[]; };
layout(push_constant, std430) uniform Constants { LensSearchConstants constants; };

layout(constant_id = constant_cutouts) const uint cutouts = 0;

const uint neighbours = 9;
const uint covering = 4; // the fragment that the ray falls in

struct Hit {
  uint triangle;
  Real range;
};

bool comes_before(Hit a, Hit b) {
  float difference = high(add(a.range, negate(b.range)));
  return difference < 0.0 || (difference == 0.0 && a.triangle < b.triangle);
}

const uint pairs_of_corners = 11; // of words, in TriangleCorners
Real coordinate(uint triangle, uint n) {
  vec2 pair = uintBitsToFloat(load_words(constants.corners, pairs_of_corners * triangle + n));
  return real(pair.x, pair.y);
}
Real3 corner(uint triangle, uint n) {
  return Real3(coordinate(triangle, 3 * n), coordinate(triangle, 3 * n + 1), coordinate(triangle, 3 * n + 2));
}

// Which of the edges ab, bc, ca the straight way to the ray leaves the triangle by; no_edge where the ray meets it, edges
// included. Neighbours take the same bits for their common edge, so no ray slips through between them. `across` points to the
// left of the way.
const uint no_edge = 3;
uint way_out(Real3 ray, uint triangle, vec3 across) {
  Real3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  vec3 sides = vec3(high(dot3(ray, cross3(a, b))), high(dot3(ray, cross3(b, c))), high(dot3(ray, cross3(c, a))));
  bool clockwise = sides.x + sides.y + sides.z < 0.0;
  bvec3 beyond = lessThan(clockwise ? -sides : sides, vec3(0.0));
  if (!any(beyond))
    return no_edge;
  // Where the ray is beyond two edges, the way passes their common corner on one side or the other.
  uint first = beyond.x && !beyond.z ? 0u : beyond.y && !beyond.x ? 1u : 2u, second = first == 2u ? 0u : first + 1u;
  bool is_beyond_both = (beyond.x && beyond.y) || (beyond.y && beyond.z) || (beyond.z && beyond.x);
  bool is_left = dot(across, high3(first == 0u ? b : first == 1u ? c : a)) > 0.0;
  return is_beyond_both && is_left == clockwise ? second : first;
}

Real range_along(Real3 ray, uint triangle) {
  vec4 plane_hi = load_vec4(constants.planes, 3 * triangle), plane_lo = load_vec4(constants.planes, 3 * triangle + 1);
  return divide(real(plane_hi.w, plane_lo.w), dot3(real3(plane_hi.xyz, plane_lo.xyz), ray));
}

bool is_there(uint id, Real3 point) {
  return cutouts == 0 || look_of(constants.shapes, constants.surfaces, id, point).is_there;
}

// The shapes that a sample has still to ask.
struct Search {
  uint seen[neighbours]; // by the fragments around its ray
  uint asked;            // a bit for each of them
  bool in_rim;           // then the candidates from the next one on instead
  uint candidate;
  vec2 middle; // of the fragment that the ray falls in
};

// The search, which begins with what the fragments around the ray see.
Search search_around(vec3 ray, RasterView view) {
  vec2 fragment = vec2(dot(view.x.xyz, ray), dot(view.y.xyz, ray)) / dot(view.z.xyz, ray);
  ivec2 cell = clamp(ivec2(floor(fragment)), ivec2(1), ivec2(view.columns, view.rows) - 2);
  Search search;
  search.asked = 0u;
  uint mark = 0u;
  [[unroll]] for (uint n = 0; n < neighbours; ++n) {
    ivec2 at = cell + ivec2(n % 3, n / 3) - 1;
    uvec2 ids = load_words(constants.fragments, uint(at.y) * view.columns + uint(at.x));
    bool hit = (ids.x & fragment_hit) != 0u;
    search.seen[n] = hit ? ids.y : no_triangle;
    search.asked |= hit ? 0u : 1u << n;
    mark = n == covering ? ids.x / 2u : mark;
  }
  search.in_rim = mark != 0u;
  search.candidate = mark - 1u;
  search.middle = vec2(cell) + 0.5;
  return search;
}

// The next shape that may be seen at that depth or before and has not been asked yet; no_triangle in the end. `across` becomes
// the vector across the way from where the shape is seen to the ray.
uint next(inout Search search, float depth_m, Real3 ray, RasterView view, inout vec3 across) {
  if (search.in_rim) {
    RimCandidate candidate = RimCandidates(constants.candidates).at[search.candidate++];
    return candidate.depth_m <= depth_m ? candidate.shape : no_triangle;
  }
  uint first = findLSB(~search.asked), triangle = no_triangle;
  [[unroll]] for (uint n = 0; n < neighbours; ++n)
    triangle = n == first ? search.seen[n] : triangle;
  [[unroll]] for (uint n = 0; n < neighbours; ++n)
    search.asked |= search.seen[n] == triangle ? 1u << n : 0u;
  vec2 seen_at = search.middle + vec2(first % 3, first / 3) - 1.0;
  across = cross(seen_at.x * view.ray_x.xyz + seen_at.y * view.ray_y.xyz + view.ray_corner.xyz, high3(ray));
  return triangle;
}

// The hit where the ray meets what is seen first. The search walks from what the fragments see from neighbour to neighbour, as
// triangles smaller than fragments may not be seen by any; in a rim cell it knows all. It is a single loop that ends at its
// end: lanes wait for each other, and lavapipe runs what follows a break once more for nobody.
const uint longest_walk = 1024;
Hit nearest(Real3 ray, RasterView view) {
  const float anywhere = uintBitsToFloat(0x7f800000u);
  Search search = search_around(high3(ray), view);
  Hit best = Hit(no_triangle, real(0.0));
  float depth_m = anywhere;
  vec3 across = vec3(0.0);
  uint triangle = next(search, depth_m, ray, view, across), walked = 0u;
  if (triangle == no_triangle)
    return best;
  do {
    uint edge = way_out(ray, triangle, across), beyond = no_triangle;
    if (edge == no_edge) {
      Hit hit = Hit(triangle, range_along(ray, triangle));
      if (high(hit.range) > 0.0 && (best.triangle == no_triangle || comes_before(hit, best)) &&
          is_there(triangle, scale3(ray, hit.range))) {
        best = hit;
        depth_m = high(hit.range) * dot(view.z.xyz, high3(ray));
      }
    } else if (!search.in_rim && walked < longest_walk)
      beyond = Corners(constants.corners).at[triangle].beyond[edge];
    walked = beyond != no_triangle ? walked + 1u : 0u;
    triangle = beyond != no_triangle ? beyond : next(search, depth_m, ray, view, across);
  } while (triangle != no_triangle);
  return best;
}

void main() {
  Strip strip = constants.strip;
  uint i = gl_GlobalInvocationID.x;
  PointBuffers to = PointBuffers(constants.position, constants.surface, constants.backscatter,
                                 constants.shapes, constants.surfaces);
  Sample at = sample_of(i, strip);
  // Before anything branches, so that lavapipe reads lens and view once for all lanes.
  RasterView view = Views(constants.view).at;
  Lenses lens = Lenses(constants.lens);
  bool has_ray;
  Real3 ray = undistorted_ray(lens, place_on_chip(lens.at.chip, strip, at.in_frame, from_centre_of(at.subsample, strip)), has_ray);
  if (at.pixel >= strip.columns * strip.rows) {
    store_miss(to, i);
    return;
  }
  if (dark_beyond_fold != 0 && !has_ray)
    ray = Real3(real(view.ray_corner.x), real(view.ray_corner.y), real(view.ray_corner.z)); // any that the search may follow
  Hit hit = nearest(ray, view);
  uint id_at = id_index(at.in_strip, at.subsample, uvec2(strip.columns, strip.rows), strip.samples, false);
  if (hit.triangle == no_triangle || (dark_beyond_fold != 0 && !has_ray)) {
    store_words(constants.ids, id_at, uvec2(0u));
    store_miss(to, i);
    return;
  }
  store_words(constants.ids, id_at, uvec2(at.in_frame.y * strip.resolution_x + at.in_frame.x + 1u, hit.triangle));
  store_point(to, i, high3(ray), scale3(ray, hit.range), hit.triangle, load_plane(constants.planes, hit.triangle));
}
