// The pixel that a fragment belongs to.
#ifndef PMDSIM_PIXEL_ID_GLSL
#define PMDSIM_PIXEL_ID_GLSL

// `fragment` counts from the tile's corner; `side` as fragments_per_pixel_side (interface.h).
uint pixel_id(vec2 fragment, uvec2 first_pixel, uint resolution_x, uint side) {
  // By a float, exact for this: lavapipe divides whole numbers lane by lane.
  uvec2 pixel = first_pixel + uvec2((fragment + 0.5) / float(max(side, 1u)));
  return side == 0u ? 1u : pixel.y * resolution_x + pixel.x + 1u;
}

#endif
