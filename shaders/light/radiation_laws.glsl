// Radiation laws, J of the paper's eq. 5, each for floats and, where SUM_IN_REAL is defined, for Real: by other algebra, as a
// sum of floats shares its one division. The host takes all that it asks of a law from its row in
// engine/light/radiation_laws.cpp.
// DIAGRAM_VALUES: the address of the values of all measured diagrams, each with the next theta's.
#ifndef PMDSIM_RADIATION_LAWS_GLSL
#define PMDSIM_RADIATION_LAWS_GLSL

#ifdef SUM_IN_REAL
#include "shaders/light/precise_diagrams.glsl"
#include "shaders/shared/real_elementary.glsl"

Real half_of(Real a) { return multiply(a, real(0.5)); }

// a, or 0 where it is negative.
Real at_least_zero(Real a) { return high(a) > 0.0 ? a : real(0.0); }
#endif

// A cosine to the power that all diodes share.

// x to the whole part of it.
float whole_power(float x) {
  float result = 1.0;
  [[unroll]] for (uint n = 0; n < cosine_order; ++n)
    result *= x;
  return result;
}

// x to what is left of it; x from 0 to 2.
float fraction_of_power(float x) {
  float limited = max(x, 1e-37);
  float power = exp_of(cosine_fraction * log_of(limited, 1.0 - limited));
  return cosine_fraction > 0.0 ? (x > 0.0 ? power : 0.0) : 1.0;
}

float shared_power(float cosine) { return whole_power(cosine) * fraction_of_power(cosine); }

// The same of lengths: a cosine's r is left out of the whole part, and rho stands for it in the fraction.
float power_of_lengths(float along_m, float rho_m) {
  return whole_power(along_m) * fraction_of_power(along_m / rho_m);
}

#ifdef SUM_IN_REAL
Real whole_power(Real x) {
  Real result = real(1.0);
  [[unroll]] for (uint n = 0; n < cosine_order; ++n)
    result = multiply(result, x);
  return result;
}
#endif

// A cosine to a power of its diode.

// cos^n = exp(n/2 * log(1 - sin^2)): near the axis, where a narrow beam's light is, the sine of the angle keeps its
// digits and the cosine does not.
float real_power(Point point, GroupSource diode, float along_m, float inverse_r2) {
  vec3 d = point.position + 0.5 * diode.position.xyz; // from the diode to the point
  vec3 across = cross(diode.axis.xyz, d);
  float sine2 = min(dot(across, across) * inverse_r2, 1.0);
  float cosine2 = clamp(sine2 < 0.5 ? 1.0 - sine2 : along_m * along_m * inverse_r2, 1e-37, 1.0);
  float j = exp_of(0.5 * diode.order * log_of(cosine2, sine2));
  return along_m > 0.0 ? j : 0.0;
}

#ifdef SUM_IN_REAL
Real real_power(Real3 way, Real3 axis, Real order, Real along_m, Real r2) {
  Real3 across = cross3(axis, way);
  Real sine2 = real_clamp(divide(dot3(across, across), r2), 0.0, 1.0);
  Real cosine2 = high(sine2) < 0.5 ? add(real(1.0), negate(sine2)) : divide(multiply(along_m, along_m), r2);
  Real j = real_exp_of(multiply(half_of(order), real_log_of(real_clamp(cosine2, 1e-37, 1.0), sine2)));
  return high(along_m) > 0.0 ? j : real(0.0);
}
#endif

// A measured diagram: J from a table on even grids of theta, the angle to the diode's axis, and phi, the angle about it
// (engine/light/diagram_tables.h). It holds floats; precise_diagrams.glsl has the other form.

// The angle of (x, y) in radians, 0 to pi, y >= 0 and `length` the length: twice the arctangent of its half within 45
// degrees, to 2e-8 of it.
float half_plane_angle(float x, float y, float length) {
  float larger = max(abs(x), y), smaller = min(abs(x), y);
  float t = smaller / (length + larger);
  float u = t * t;
  float angle = t * (1.999999963 + u * (-0.6666557154 + u * (0.3994816483 + u * (-0.2769698042 + u * 0.1595258361))));
  angle = y > abs(x) ? 1.57079633 - angle : angle;
  return x < 0.0 ? 3.14159265 - angle : angle;
}

// Tables hold each value with the next one of its row, for lavapipe fetches component by component and lane by lane: there a
// double, which is one component, takes half the time of a vec2.
#ifdef REAL_DOUBLE_FLOAT
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Pairs { vec2 at[]; };
vec2 pair_at(uint i) { return Pairs(DIAGRAM_VALUES).at[i]; }
#else
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Pairs { double at[]; };
vec2 pair_at(uint i) { return uintBitsToFloat(unpackDouble2x32(Pairs(DIAGRAM_VALUES).at[i])); }
#endif

// The last value of a row at or before a place in it, and how far the place is beyond it; places outside 0 ... last (and what
// is not a number) are at its beginning.
struct Place {
  uint lower;
  float fraction;
  bool inside;
};

Place place_at(float steps, float last) {
  bool inside = steps >= 0.0 && steps <= last;
  float within = inside ? steps : 0.0;
  int lower = int(within); // CPUs convert to int and back in one instruction, to uint in many
  return Place(uint(lower), within - float(lower), inside);
}

float interpolated(uint row, Place place) {
  vec2 pair = pair_at(row + place.lower);
  return mix(pair.x, pair.y, place.fraction);
}

// The way from a diode to a point, m.
struct Way {
  vec3 way;
  vec3 around;   // axis x way
  float r;       // its length
  float along;   // its part along the axis
  float off_axis;
};

Way way_from(GroupSource diode, Point point, float along_m, float r) {
  vec3 way = point.position + 0.5 * diode.position.xyz;
  vec3 around = cross(diode.axis.xyz, way); // which keeps its digits near the axis, where a narrow beam's light is
  return Way(way, around, r, along_m, sqrt(dot(around, around)));
}

Place theta_place(Way way, GroupSource diode) {
  float theta = half_plane_angle(way.along, way.off_axis, way.r);
  return place_at((theta - diode.first_theta) * diode.theta_steps_per_rad, diode.theta_steps);
}

Place phi_place(Way way, GroupSource diode) {
  float x = dot(diode.across.xyz, way.way);
  float y = -dot(diode.across.xyz, way.around); // along axis x across
  float turns = 0.159154943 * half_plane_angle(x, abs(y), way.off_axis);
  return place_at((y < 0.0 ? 1.0 - turns : turns) * diode.across.w, diode.across.w);
}

// J where it is the same for all phi.
float axial_diagram(Way way, GroupSource diode) {
  Place theta = theta_place(way, diode);
  float j = interpolated(diode.diagram, theta);
  return theta.inside ? j : 0.0;
}

// J of a diagram of any kind. One that is not the same for all phi is kept at its own angles, and the even grids tell which of
// them lie around: first that of theta, then that of phi, then a row of thetas for each phi.
float diagram(Way way, GroupSource diode) {
  Place theta = theta_place(way, diode), phi = phi_place(way, diode);
  bool axial = diode.row_length == 0u;
  uint of_phi = axial ? diode.diagram : diode.diagram + uint(diode.theta_steps) + 1u;
  uint rows = axial ? diode.diagram : of_phi + uint(diode.across.w) + 1u;
  float of_theta = interpolated(diode.diagram, theta);
  Place column = place_at(axial ? 0.0 : of_theta, float(diode.row_length));
  Place row = place_at(axial ? 0.0 : interpolated(of_phi, phi), 1e9);
  uint upper = rows + row.lower * diode.row_length;
  float j = mix(interpolated(upper, column), interpolated(upper + diode.row_length, column), row.fraction);
  return theta.inside ? (axial ? of_theta : j) : 0.0;
}

// The laws that are tables.
float law_of_table(Way way, GroupSource diode) {
  return pattern_model == pattern_axial ? axial_diagram(way, diode) : diagram(way, diode);
}

// J of a diode, whose law GroupSource::order tells.

float radiation(Point point, GroupSource diode, float r, float inverse_r, float inverse_r2) {
  float along_m = dot(diode.axis.xyz, point.position) - diode.axis.w;
  if (pattern_model == pattern_power)
    return shared_power(max(0.0, along_m * inverse_r));
  if (pattern_model == pattern_axial)
    return law_of_table(way_from(diode, point, along_m, r), diode);
  float j = diode.order < 0.0 ? 1.0 : real_power(point, diode, along_m, inverse_r2);
  if (pattern_model == pattern_any)
    j = diode.order < -1.0 ? law_of_table(way_from(diode, point, along_m, r), diode) : j;
  return j;
}

#ifdef SUM_IN_REAL
// `from_reference`: P - G; `way`: from the diode to the point; m.
Real radiation(Real3 from_reference, Real3 way, PreciseSource diode, Real r, Real r2) {
  Real3 axis = real3(diode.rounded.axis.xyz, diode.axis_rest.xyz);
  Real along_m = add(dot3(axis, from_reference), negate(real(diode.rounded.axis.w, diode.axis_rest.w)));
  if (pattern_model == pattern_power && cosine_fraction == 0.0)
    return whole_power(at_least_zero(divide(along_m, r)));
  if (pattern_model == pattern_axial)
    return precise_diagram(way, axis, diode, along_m);
  Real order = real(diode.rounded.order, diode.order_rest);
  Real j = diode.rounded.order < 0.0 ? real(1.0) : real_power(way, axis, order, along_m, r2);
  if (pattern_model == pattern_any)
    if (diode.rounded.order < -1.0)
      j = precise_diagram(way, axis, diode, along_m);
  return j;
}
#endif

#endif
