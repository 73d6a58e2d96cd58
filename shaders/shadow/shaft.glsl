// All the straight ways from a box of points to a box of diodes: a box that moves from one to the other.
#ifndef PMDSIM_SHAFT_GLSL
#define PMDSIM_SHAFT_GLSL

struct Shaft {
  vec3 low, high;                 // at the points
  vec3 low_way, high_way;         // from there to the diodes
  vec3 per_low_way, per_high_way; // 1 / way
};

// Never 0, so that a way along which nothing moves is a very slow one.
vec3 inverse_way(vec3 way) {
  vec3 moving = mix(way, vec3(1e-30), lessThan(abs(way), vec3(1e-30)));
  return 1.0 / moving;
}

Shaft shaft_between(vec3 low, vec3 high, vec3 diodes_low, vec3 diodes_high) {
  vec3 low_way = diodes_low - low, high_way = diodes_high - high;
  return Shaft(low, high, low_way, high_way, inverse_way(low_way), inverse_way(high_way));
}

// Whether the box, somewhere on its way, may meet another. At t of the way it spans low + t low_way to high + t high_way, and
// each face of the other box leaves a range of t; the ranges have something in common or not. Rounding moves an end of a range
// by a few units in the last place of t, and t is at most 1.
bool may_meet(Shaft shaft, vec3 low, vec3 high) {
  vec3 t_low = (high - shaft.low) * shaft.per_low_way;  // low end = the other's high end
  vec3 t_high = (low - shaft.high) * shaft.per_high_way; // high end = the other's low end
  bvec3 low_grows = greaterThan(shaft.per_low_way, vec3(0.0));
  bvec3 high_grows = greaterThan(shaft.per_high_way, vec3(0.0));
  vec3 until = min(mix(vec3(1.0), t_low, low_grows), mix(t_high, vec3(1.0), high_grows));
  vec3 from = max(mix(t_low, vec3(0.0), low_grows), mix(vec3(0.0), t_high, high_grows));
  float last = min(min(until.x, until.y), min(until.z, 1.0));
  float first = max(max(from.x, from.y), max(from.z, 0.0));
  const float slack = 1e-6;
  return first <= last + slack && last >= -slack;
}

#endif
