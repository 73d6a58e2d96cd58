// J from a measured diagram's table on even grids of theta, the angle to the diode's axis, and phi, the angle about it
// (engine/light/diagram_tables.h). DIAGRAM_VALUES: the address of the values of all, each with the next theta's.
#ifndef PMDSIM_DIAGRAM_GLSL
#define PMDSIM_DIAGRAM_GLSL

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

// The last value of a row at or before a place in it, and how far beyond that is; places outside 0 ... last (and what is
// not a number) are at its beginning.
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
  float along;   // of it, the axis
  float off_axis;
};

Way way_from(GroupDiode diode, Point point, float along_m, float r) {
  vec3 way = point.position + 0.5 * diode.position.xyz;
  vec3 around = cross(diode.axis.xyz, way); // which keeps its digits near the axis, where a narrow beam's light is
  return Way(way, around, r, along_m, sqrt(dot(around, around)));
}

Place theta_place(Way way, GroupDiode diode) {
  float theta = half_plane_angle(way.along, way.off_axis, way.r);
  return place_at((theta - diode.first_theta) * diode.theta_steps_per_rad, diode.theta_steps);
}

Place phi_place(Way way, GroupDiode diode) {
  float x = dot(diode.across.xyz, way.way);
  float y = -dot(diode.across.xyz, way.around); // along axis x across
  float turns = 0.159154943 * half_plane_angle(x, abs(y), way.off_axis);
  return place_at((y < 0.0 ? 1.0 - turns : turns) * diode.across.w, diode.across.w);
}

// J where it is the same for all phi.
float axial_diagram(Way way, GroupDiode diode) {
  Place theta = theta_place(way, diode);
  float j = interpolated(diode.diagram, theta);
  return theta.inside ? j : 0.0;
}

// Of any kind. One that is not the same for all phi is kept at its own angles, and the even grids tell which of them lie
// around: first that of theta, then that of phi, then a row of thetas for each phi.
float diagram(Way way, GroupDiode diode) {
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

#endif
