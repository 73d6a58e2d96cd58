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

const uint words_per_corners = 11; // pairs of them, of TriangleCorners
Real coordinate(uint triangle, uint n) {
  vec2 pair = uintBitsToFloat(load_words(constants.corners, words_per_corners * triangle + n));
  return real(pair.x, pair.y);
}
Real3 corner(uint triangle, uint n) {
  return Real3(coordinate(triangle, 3 * n), coordinate(triangle, 3 * n + 1), coordinate(triangle, 3 * n + 2));
}

// Which of the edges ab, bc, ca the ray passes beyond, the farthest off; no_edge inside and on edges. Neighbours take the
// same bits for their common edge, so no ray slips through between them.
const uint no_edge = 3;
uint edge_beyond(Real3 ray, uint triangle) {
  Real3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  vec3 sides = vec3(high(dot3(ray, cross3(a, b))), high(dot3(ray, cross3(b, c))), high(dot3(ray, cross3(c, a))));
  sides = sides.x + sides.y + sides.z < 0.0 ? -sides : sides;
  float farthest = min(sides.x, min(sides.y, sides.z));
  if (farthest >= 0.0)
    return no_edge;
  return sides.x == farthest ? 0u : sides.y == farthest ? 1u : 2u;
}

uint triangle_beyond(uint triangle, uint edge) {
  return Words(constants.corners).at[2 * (words_per_corners * triangle + 9) + edge];
}

Real range_along(Real3 ray, uint triangle) {
  vec4 plane_hi = load_vec4(constants.planes, 3 * triangle), plane_lo = load_vec4(constants.planes, 3 * triangle + 1);
  return divide(real(plane_hi.w, plane_lo.w), dot3(real3(plane_hi.xyz, plane_lo.xyz), ray));
}

bool is_there(uint id, Real3 point) {
  return cutouts == 0 || look_of(constants.shapes, constants.surfaces, id, point).is_there;
}

// What a sample has still to ask.
struct Search {
  uint seen[neighbours]; // by the fragments around its ray
  uint asked;            // a bit for each of them
  bool in_rim;           // then the candidates from the next one on instead
  uint candidate;
};

// What the fragments around the ray see.
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
  return search;
}

// Of what may be seen at that depth or before, what has not been asked yet; no_triangle in the end.
uint next(inout Search search, float depth_m) {
  if (search.in_rim) {
    uvec2 candidate = load_words(constants.candidates, search.candidate++);
    return uintBitsToFloat(candidate.y) <= depth_m ? candidate.x : no_triangle;
  }
  uint first = findLSB(~search.asked), triangle = no_triangle;
  [[unroll]] for (uint n = 0; n < neighbours; ++n)
    triangle = n == first ? search.seen[n] : triangle;
  [[unroll]] for (uint n = 0; n < neighbours; ++n)
    search.asked |= search.seen[n] == triangle ? 1u << n : 0u;
  return triangle;
}

// Where the ray meets what is seen first. On what the fragments see it walks from neighbour to neighbour, as triangles
// smaller than fragments may not be seen by any; a rim cell has them all. One loop, which all lanes go through as often as
// the slowest: a body in it is run once more than a loop is.
const uint longest_walk = 64;
Hit nearest(Real3 ray, Search search, float axis_cosine) {
  const float anywhere = uintBitsToFloat(0x7f800000u);
  Hit best = Hit(no_triangle, real(0.0));
  float depth_m = anywhere;
  uint triangle = next(search, depth_m), walked = 0u;
  if (triangle == no_triangle)
    return best;
  do {
    uint edge = edge_beyond(ray, triangle), beyond = no_triangle;
    if (edge == no_edge) {
      Hit hit = Hit(triangle, range_along(ray, triangle));
      if (high(hit.range) > 0.0 && (best.triangle == no_triangle || comes_before(hit, best)) &&
          is_there(triangle, scale3(ray, hit.range))) {
        best = hit;
        depth_m = high(hit.range) * axis_cosine;
      }
    } else if (!search.in_rim && walked < longest_walk)
      beyond = triangle_beyond(triangle, edge);
    walked = beyond != no_triangle ? walked + 1u : 0u;
    triangle = beyond != no_triangle ? beyond : next(search, depth_m);
  } while (triangle != no_triangle);
  return best;
}

void main() {
  Strip strip = constants.strip;
  uint i = gl_GlobalInvocationID.x;
  PointBuffers to = PointBuffers(constants.position, constants.surface, constants.backscatter,
                                 constants.shapes, constants.surfaces);
  Sample at = sample_of(i, strip);
  // Before anything branches, so that lavapipe reads the lens once for all lanes.
  Lenses lens = Lenses(constants.lens);
  Real3 ray = undistorted_ray(lens, place_on_chip(lens.at.chip, strip, at.in_frame, from_centre_of(at.subsample, strip)));
  if (at.pixel >= strip.columns * strip.rows) {
    store_miss(to, i);
    return;
  }
  RasterView view = Views(constants.view).at;
  Hit hit = nearest(ray, search_around(high3(ray), view), dot(view.z.xyz, high3(ray)));
  uint id_at = id_index(at.in_strip, at.subsample, uvec2(strip.columns, strip.rows), strip.samples, false);
  if (hit.triangle == no_triangle) {
    store_words(constants.ids, id_at, uvec2(0u));
    store_miss(to, i);
    return;
  }
  store_words(constants.ids, id_at, uvec2(at.in_frame.y * strip.resolution_x + at.in_frame.x + 1u, hit.triangle));
  store_point(to, i, high3(ray), scale3(ray, hit.range), hit.triangle, load_plane(constants.planes, hit.triangle));
}
