#pragma once
// Cuts elements where what arrives changes fast along them: near other surfaces, as the harmonic mean of the
// distances around a place tells (G. Ward and P. Heckbert, "Irradiance gradients", Eurographics Workshop on
// Rendering, 1992), and where one end lies under something that stands on the surface.

#include "engine/surfaces/facet_tree.h"

namespace pmdsim {

// The tree is that of the elements as they are before.
void grade_elements(const Scene &scene, const FacetTree &tree, Elements &elements);

} // namespace pmdsim
