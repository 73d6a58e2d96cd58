// A measured diagram in Real: J at its own angles, between which it is linear (engine/light/precise_diagrams.h). DIAGRAM_VALUES is
// the address of that table here.
#ifndef PMDSIM_PRECISE_DIAGRAMS_GLSL
#define PMDSIM_PRECISE_DIAGRAMS_GLSL

#include "shaders/shared/real_elementary.glsl"

layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer RealPairs { vec2 at[]; };

Real diagram_number(uint i) {
  vec2 pair = RealPairs(DIAGRAM_VALUES).at[i];
  return real(pair.x, pair.y);
}

bool is_less(Real a, Real b) { return high(add(a, negate(b))) < 0.0; }

// The last of some angles at or before another, how much of the way to the next that is, and whether it is among them at all.
struct PrecisePlace {
  uint lower, upper;
  Real fraction;
  bool inside;
};

PrecisePlace place_among(uint first, uint count, Real turns) {
  bool inside = !is_less(turns, diagram_number(first)) && !is_less(diagram_number(first + count - 1), turns);
  uint lower = 0, upper = count - 1;
  while (upper - lower > 1) {
    uint middle = (lower + upper) / 2;
    bool beyond = !is_less(turns, diagram_number(first + middle));
    lower = beyond ? middle : lower;
    upper = beyond ? upper : middle;
  }
  Real from = diagram_number(first + lower), to = diagram_number(first + upper);
  Real fraction = inside && upper > lower ? divide(add(turns, negate(from)), add(to, negate(from))) : real(0.0);
  return PrecisePlace(lower, upper, fraction, inside);
}

Real between(Real a, Real b, Real fraction) { return add(a, multiply(fraction, add(b, negate(a)))); }

Real in_row(uint row, PrecisePlace place) {
  return between(diagram_number(row + place.lower), diagram_number(row + place.upper), place.fraction);
}

// `way`: from the diode to the point, `along_m` of it along the axis.
Real precise_diagram(Real3 way, Real3 axis, PreciseSource diode, Real along_m) {
  vec2 counts = RealPairs(DIAGRAM_VALUES).at[diode.diagram];
  uint thetas = uint(counts.x), phis = uint(counts.y);
  uint of_theta = diode.diagram + 1u, of_phi = of_theta + thetas, rows = of_phi + phis;
  Real3 around = cross3(axis, way);
  PrecisePlace theta = place_among(of_theta, thetas, real_angle_turns(RealComplex(along_m, length3(around))));
  if (!theta.inside)
    return real(0.0);
  if (phis == 0u)
    return in_row(rows, theta);
  Real3 across = real3(diode.rounded.across.xyz, diode.across_rest.xyz);
  RealComplex about = RealComplex(dot3(across, way), negate(dot3(across, around)));
  bool on_axis = high(about.re) == 0.0 && high(about.im) == 0.0;
  Real turns = on_axis ? real(0.0) : real_angle_turns(about);
  if (high(turns) < 0.0)
    turns = add(turns, real(1.0));
  PrecisePlace phi = place_among(of_phi, phis, turns);
  return between(in_row(rows + phi.lower * thetas, theta), in_row(rows + phi.upper * thetas, theta), phi.fraction);
}

#endif
