// J, the radiation diagram of a diode towards a point: max(0, cos theta)^n, 1, or a table.
#ifndef PMDSIM_RADIATION_GLSL
#define PMDSIM_RADIATION_GLSL

#include "shaders/light/diagram.glsl"

float whole_power(float x) {
  float result = 1.0;
  [[unroll]] for (uint n = 0; n < cosine_order; ++n)
    result *= x;
  return result;
}

// cos^n = exp(n/2 * log(1 - sin^2)): near the axis, where a narrow beam's light is, the sine of the angle keeps its
// digits and the cosine does not.
float real_power(Point point, GroupDiode diode, float along_m, float inverse_r2) {
  vec3 d = point.position + 0.5 * diode.position.xyz; // from the diode to the point
  vec3 across = cross(diode.axis.xyz, d);
  float sine2 = min(dot(across, across) * inverse_r2, 1.0);
  float cosine2 = clamp(sine2 < 0.5 ? 1.0 - sine2 : along_m * along_m * inverse_r2, 1e-37, 1.0);
  float j = exp_of(0.5 * diode.order * log_of(cosine2, sine2));
  return along_m > 0.0 ? j : 0.0;
}

float radiation(Point point, GroupDiode diode, float r, float inverse_r, float inverse_r2) {
  float along_m = dot(diode.axis.xyz, point.position) - diode.axis.w;
  if (pattern_model == pattern_power)
    return whole_power(max(0.0, along_m * inverse_r));
  if (pattern_model == pattern_axial)
    return axial_diagram(way_from(diode, point, along_m, r), diode);
  float j = diode.order < 0.0 ? 1.0 : real_power(point, diode, along_m, inverse_r2);
  if (pattern_model == pattern_any)
    j = diode.order < -1.0 ? diagram(way_from(diode, point, along_m, r), diode) : j;
  return j;
}

#endif
