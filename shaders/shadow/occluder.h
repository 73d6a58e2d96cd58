// Shapes that may stand in the light, by the rules of interface.h.
#ifndef PMDSIM_OCCLUDER_H
#define PMDSIM_OCCLUDER_H

#include "shaders/shared/interface.h"

#ifdef __cplusplus
namespace pmdsim::shader {
#endif

// A triangle, or the one around a disc. Camera frame, m.
struct Occluder {
  vec4 plane_hi, plane_lo; // unit normal (counter-clockwise abc in front), offset
  vec4 a_hi, b_hi, c_hi;   // corners
  vec4 a_lo, b_lo, c_lo;
  uint id;    // of the shape in the scene
  uint edges; // bit 0, 1, 2: ab, bc, ca run from the corner that comes later (mesh_edges.h)
  uint padding_1, padding_2;
};

#ifdef __cplusplus
static_assert(sizeof(Occluder) == 144);
} // namespace pmdsim::shader
#endif

#endif
