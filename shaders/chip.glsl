// Where a sample lies on the chip (DESIGN section 2, eq. 1).
#ifndef PMDSIM_CHIP_GLSL
#define PMDSIM_CHIP_GLSL

#include "buffers.glsl"
#include "real.glsl"

Real3 term(int count, vec4 hi, vec4 lo) { return scale3(real3(hi.xyz, lo.xyz), real(float(count))); }

// Camera frame, seen in front of the lens. `pixel` counts over the whole frame, `subsample` within the pixel.
Real3 place_on_chip(ChipPlace chip, Strip strip, uvec2 pixel, uvec2 subsample) {
  ivec2 from_middle = 2 * ivec2(pixel) + 1 - ivec2(strip.resolution_x, strip.resolution_y);
  ivec2 from_centre = 2 * ivec2(subsample) + 1 - int(strip.samples);
  Real3 place = real3(chip.origin_hi.xyz, chip.origin_lo.xyz);
  place = add3(place, term(from_middle.x, chip.half_column_hi, chip.half_column_lo));
  place = add3(place, term(from_middle.y, chip.half_row_hi, chip.half_row_lo));
  place = add3(place, term(from_centre.x, chip.half_step_x_hi, chip.half_step_x_lo));
  return add3(place, term(from_centre.y, chip.half_step_y_hi, chip.half_step_y_lo));
}

#endif
