#pragma once
// Cuts elements of which one end lies under something that stands on them: where it begins, what arrives
// jumps from all to nothing.

#include "engine/radiosity/facet_tree.h"

namespace pmdsim {

// The tree is that of the elements as they are before.
void cut_at_contacts(const Scene &scene, const FacetTree &tree, Elements &elements);

} // namespace pmdsim
