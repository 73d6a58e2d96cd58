// Where a sample lies on the chip (eq. 1; docs/theory.md, "Conventions"), and the ray that comes from it through the lens.
#ifndef PMDSIM_CHIP_GLSL
#define PMDSIM_CHIP_GLSL

#include "shaders/shared/buffers.glsl"
#include "shaders/shared/real.glsl"

Real3 term(float count, vec4 hi, vec4 lo) { return scale3(real3(hi.xyz, lo.xyz), real(count)); }

// From the pixel's centre to a sample, in half the distance of neighbouring samples.
vec2 from_centre_of(uvec2 subsample, Strip strip) { return vec2(2 * ivec2(subsample) + 1 - int(strip.samples)); }

// From the frame's middle to the pixel's centre, in half pixels; `pixel` counts over the whole frame.
ivec2 from_middle_of(uvec2 pixel, Strip strip) {
  return 2 * ivec2(pixel) + 1 - ivec2(strip.resolution_x, strip.resolution_y);
}

// Camera frame, seen in front of the lens.
Real3 place_on_chip(ChipPlace chip, Strip strip, uvec2 pixel, vec2 from_centre) {
  vec2 from_middle = vec2(from_middle_of(pixel, strip));
  Real3 place = real3(chip.origin_hi.xyz, chip.origin_lo.xyz);
  place = add3(place, term(from_middle.x, chip.half_column_hi, chip.half_column_lo));
  place = add3(place, term(from_middle.y, chip.half_row_hi, chip.half_row_lo));
  place = add3(place, term(from_centre.x, chip.half_step_x_hi, chip.half_step_x_lo));
  return add3(place, term(from_centre.y, chip.half_step_y_hi, chip.half_step_y_lo));
}

// The ray (x, y, 1) through a nominal chip; `slope` as in PointsConstants.
Real3 nominal_ray(vec4 slope, Strip strip, uvec2 pixel, vec2 from_centre) {
  vec2 centre = vec2(from_middle_of(pixel, strip) * int(strip.samples)); // in half samples, exact in float
  Real x = multiply(add(real(centre.x), real(from_centre.x)), real(slope.x, slope.y));
  Real y = multiply(add(real(centre.y), real(from_centre.y)), real(slope.z, slope.w));
  return Real3(x, y, real(1.0));
}

// The same of any chip.
Real3 chip_ray(ChipPlace chip, Strip strip, uvec2 pixel, vec2 from_centre) {
  Real3 place = place_on_chip(chip, strip, pixel, from_centre);
  return Real3(divide(place.x, place.z), divide(place.y, place.z), real(1.0));
}

// The ray (x, y, 1) of a sample of a grid, `place` in half samples from the frame's middle; `general`: of any chip.
Real3 grid_ray(vec4 slope, uvec2 chip_at, vec2 place, bool general) {
  if (!general)
    return Real3(multiply(real(place.x), real(slope.x, slope.y)), multiply(real(place.y), real(slope.z, slope.w)), real(1.0));
  ChipPlace chip = Chips(chip_at).at;
  Real3 at = add3(real3(chip.origin_hi.xyz, chip.origin_lo.xyz), term(place.x, chip.half_step_x_hi, chip.half_step_x_lo));
  at = add3(at, term(place.y, chip.half_step_y_hi, chip.half_step_y_lo));
  return Real3(divide(at.x, at.z), divide(at.y, at.z), real(1.0));
}

#endif
