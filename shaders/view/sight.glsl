// Inputs from the vertex shader that the fragments of a triangle share where they leave records: lavapipe fetches a flat input
// once for all fragments that are shaded side by side, but a push constant for each.
#ifndef PMDSIM_SIGHT_GLSL
#define PMDSIM_SIGHT_GLSL

#ifdef VERTEX_STAGE
#define SHARED flat out
#else
#define SHARED flat in
#endif
layout(location = 1) SHARED vec4 plane_hi;   // as in TrianglePlane
layout(location = 2) SHARED vec4 plane_lo;
layout(location = 3) SHARED vec2 along_m;    // least, most depth
layout(location = 4) SHARED vec4 grid_slope; // as in SampleGrid
layout(location = 5) SHARED vec2 grid_first;
layout(location = 6) SHARED uvec4 strip_place; // column, row, resolution_x, fragments_per_pixel_side

#endif
