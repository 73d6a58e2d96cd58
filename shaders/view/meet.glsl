// Where rays meet the planes of triangles.
#ifndef PMDSIM_MEET_GLSL
#define PMDSIM_MEET_GLSL

#include "shaders/shared/interface.h"
#include "shaders/shared/real.glsl"

// The depth at which the ray (x, y, 1) meets the plane. A sample that an edge-on triangle covers only by the raster's snapping
// must not leave that triangle's depths; where its ray never meets the plane, having just passed its horizon, it sees the far end.
Real depth_on_plane(Real3 ray, TrianglePlane plane) {
  Real facing = dot3(real3(plane.plane_hi.xyz, plane.plane_lo.xyz), ray);
  Real offset = real(plane.plane_hi.w, plane.plane_lo.w);
  bool meets = high(facing) > 0.0 ? high(offset) > 0.0 : high(facing) < 0.0 && high(offset) < 0.0;
  return meets ? real_clamp(divide(offset, facing), plane.along_min, plane.along_max) : real(plane.along_max);
}

Real3 point_at_depth(Real3 ray, Real depth) { return Real3(multiply(ray.x, depth), multiply(ray.y, depth), depth); }
Real3 point_on_plane(Real3 ray, TrianglePlane plane) { return point_at_depth(ray, depth_on_plane(ray, plane)); }

#endif
