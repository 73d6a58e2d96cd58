// Sums of complex numbers that keep what rounding takes: (re, im, rest of re, rest of im).
#ifndef PMDSIM_COMPENSATED_GLSL
#define PMDSIM_COMPENSATED_GLSL

// Adds `term` (Knuth's exact sum, both parts at once).
vec4 compensated_add(vec4 sum, vec2 term) {
  precise vec2 s = sum.xy + term;
  precise vec2 v = s - sum.xy;
  precise vec2 rest = (sum.xy - (s - v)) + (term - v);
  return vec4(s, sum.zw + rest);
}

vec2 compensated_value(vec4 sum) { return sum.xy + sum.zw; }

#endif
