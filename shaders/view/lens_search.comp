#version 460
// The point of the scene that each sample sees through a lens with distortion: its ray follows from the inverse lens model,
// and meets the nearest of the surfaces that the fragment that it falls in and the eight around it see.
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

Real3 corner(TriangleCorners corners, uint n) { return real3(corners.hi[n].xyz, corners.lo[n].xyz); }

// Which of the edges ab, bc, ca the ray passes beyond, the farthest off; no_edge inside and on edges. Neighbours take the
// same bits for their common edge, so no ray slips through between them.
const uint no_edge = 3;
uint edge_beyond(Real3 ray, TriangleCorners corners) {
  Real3 a = corner(corners, 0), b = corner(corners, 1), c = corner(corners, 2);
  vec3 sides = vec3(high(dot3(ray, cross3(a, b))), high(dot3(ray, cross3(b, c))), high(dot3(ray, cross3(c, a))));
  sides = sides.x + sides.y + sides.z < 0.0 ? -sides : sides;
  float farthest = min(sides.x, min(sides.y, sides.z));
  if (farthest >= 0.0)
    return no_edge;
  return sides.x == farthest ? 0u : sides.y == farthest ? 1u : 2u;
}

Real range_along(Real3 ray, TrianglePlane plane) {
  Real3 normal = real3(plane.plane_hi.xyz, plane.plane_lo.xyz);
  return divide(real(plane.plane_hi.w, plane.plane_lo.w), dot3(normal, ray));
}

bool is_there(uint id, Real3 point) {
  return cutouts == 0 || look_of(constants.shapes, constants.surfaces, id, point).is_there;
}

// Where the ray meets the surface that `triangle` belongs to, walking from neighbour to neighbour: triangles smaller than
// fragments may not be seen by any.
const uint longest_walk = 16;
Hit walk(Real3 ray, uint triangle) {
  for (uint step = 0; step < longest_walk && triangle != no_triangle; ++step) {
    TriangleCorners corners = Corners(constants.corners).at[triangle];
    uint edge = edge_beyond(ray, corners);
    if (edge == no_edge) {
      Real range = range_along(ray, Planes(constants.planes).at[triangle]);
      return Hit(high(range) > 0.0 && is_there(triangle, scale3(ray, range)) ? triangle : no_triangle, range);
    }
    triangle = edge == 0u ? corners.beyond[0] : edge == 1u ? corners.beyond[1] : corners.beyond[2];
  }
  return Hit(no_triangle, real(0.0));
}

// Starts from each different triangle among `seen` once; the loop ends when all lanes are done.
Hit nearest(Real3 ray, uint seen[neighbours]) {
  Hit best = Hit(no_triangle, real(0.0));
  uint done = 0u;
  [[unroll]] for (uint n = 0; n < neighbours; ++n)
    done |= seen[n] == no_triangle ? 1u << n : 0u;
  while (done != (1u << neighbours) - 1u) {
    uint next = findLSB(~done), triangle = no_triangle;
    [[unroll]] for (uint n = 0; n < neighbours; ++n)
      triangle = n == next ? seen[n] : triangle;
    [[unroll]] for (uint n = 0; n < neighbours; ++n)
      done |= seen[n] == triangle ? 1u << n : 0u;
    Hit hit = walk(ray, triangle);
    if (hit.triangle != no_triangle && (best.triangle == no_triangle || comes_before(hit, best)))
      best = hit;
  }
  return best;
}

// What the fragments around the ray see.
void look_around(Real3 ray, out uint seen[neighbours]) {
  RasterView view = Views(constants.view).at;
  vec3 d = high3(ray);
  vec2 fragment = vec2(dot(view.x.xyz, d), dot(view.y.xyz, d)) / dot(view.z.xyz, d);
  ivec2 cell = clamp(ivec2(floor(fragment)), ivec2(1), ivec2(view.columns, view.rows) - 2);
  [[unroll]] for (uint n = 0; n < neighbours; ++n) {
    ivec2 at = cell + ivec2(n % 3, n / 3) - 1;
    uvec2 ids = WordPairs(constants.fragments).at[uint(at.y) * view.columns + uint(at.x)];
    seen[n] = ids.x != 0u ? ids.y : no_triangle;
  }
}

// Where surfaces are no meshes, all nine may miss the triangle that the ray meets. If there is surface all around, the
// covering fragment's stands in for it, within its own distances.
Hit hit_or_stand_in(Real3 ray, uint seen[neighbours]) {
  Hit hit = nearest(ray, seen);
  if (hit.triangle != no_triangle)
    return hit;
  bool surrounded = true;
  [[unroll]] for (uint n = 0; n < neighbours; ++n)
    surrounded = surrounded && seen[n] != no_triangle;
  if (cutouts != 0 && surrounded)
    surrounded = !may_be_absent(constants.shapes, constants.surfaces, seen[covering]);
  if (!surrounded)
    return hit;
  TrianglePlane plane = Planes(constants.planes).at[seen[covering]];
  return Hit(seen[covering], real_clamp(range_along(ray, plane), plane.along_min, plane.along_max));
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
  uint seen[neighbours];
  look_around(ray, seen);
  Hit hit = hit_or_stand_in(ray, seen);
  uint id_at = id_index(at.in_strip, at.subsample, uvec2(strip.columns, strip.rows), strip.samples, false);
  if (hit.triangle == no_triangle) {
    WordPairs(constants.ids).at[id_at] = uvec2(0u);
    store_miss(to, i);
    return;
  }
  WordPairs(constants.ids).at[id_at] = uvec2(at.in_frame.y * strip.resolution_x + at.in_frame.x + 1u, hit.triangle);
  store_point(to, i, high3(ray), scale3(ray, hit.range), hit.triangle, Planes(constants.planes).at[hit.triangle]);
}
