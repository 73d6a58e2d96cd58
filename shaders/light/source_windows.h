// The sources in the order of their visibility bits: bundles of a word's bits each, and windows of bundles whose words are
// kept at a time. By the rules of interface.h.
#ifndef PMDSIM_SOURCE_WINDOWS_H
#define PMDSIM_SOURCE_WINDOWS_H

#include "shaders/shared/interface.h"

#ifdef __cplusplus
namespace pmdsim::shader {
#endif

PMDSIM_CONSTANT bundles_per_window = 8;

// Around the diodes of a window, rounded outwards, camera frame, m.
struct DiodeBox {
  vec4 low, high;
};

// The diodes of a bundle from a place among them, m.
struct BundleDiodes {
  vec4 centre;                    // camera frame; w: how far they stand from it at most, along each axis
  vec4 extent;                    // the same for each axis
  vec4 places[diodes_per_bundle]; // where there are fewer, the last one again; w: 1 of a diode that shines
};

#ifdef __cplusplus
} // namespace pmdsim::shader
#endif

#endif
