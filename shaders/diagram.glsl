// J from a measured diagram's table on even grids of theta, the angle to the diode's axis, and phi, the angle about it
// (engine/passes/diagram_tables.h).
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

// Where between two values of a table a place is; beyond 0 ... last (and not a number) at its beginning.
struct Between {
  uint lower, upper;
  float fraction;
  bool inside;
};

Between between(float steps, float last) {
  bool inside = steps >= 0.0 && steps <= last;
  float within = inside ? steps : 0.0;
  uint lower = uint(within);
  return Between(lower, min(lower + 1, uint(last)), within - float(lower), inside);
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

Between between_thetas(Way way, GroupDiode diode) {
  float theta = half_plane_angle(way.along, way.off_axis, way.r);
  return between((theta - diode.first_theta) * diode.theta_steps_per_rad, diode.theta_steps);
}

Between between_phis(Way way, GroupDiode diode) {
  float x = dot(diode.across.xyz, way.way);
  float y = -dot(diode.across.xyz, way.around); // along axis x across
  float turns = 0.159154943 * half_plane_angle(x, abs(y), way.off_axis);
  return between((y < 0.0 ? 1.0 - turns : turns) * diode.across.w, diode.across.w);
}

// The same for all phi.
float axial_diagram(Way way, GroupDiode diode) {
  Between theta = between_thetas(way, diode);
  Floats values = Floats(constants.diagrams);
  float j = mix(values.at[diode.diagram + theta.lower], values.at[diode.diagram + theta.upper], theta.fraction);
  return theta.inside ? j : 0.0;
}

float diagram(Way way, GroupDiode diode) {
  Between theta = between_thetas(way, diode), phi = between_phis(way, diode);
  uint values_of_theta = uint(diode.across.w) + 1;
  uint lower = diode.diagram + theta.lower * values_of_theta, upper = diode.diagram + theta.upper * values_of_theta;
  Floats values = Floats(constants.diagrams);
  float j = mix(mix(values.at[lower + phi.lower], values.at[lower + phi.upper], phi.fraction),
                mix(values.at[upper + phi.lower], values.at[upper + phi.upper], phi.fraction), theta.fraction);
  return theta.inside ? j : 0.0;
}

#endif
