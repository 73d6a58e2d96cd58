#pragma once
// Speed against accuracy as a picture.

#include "host/output/pictures/canvas.h"
#include "host/output/tables/tradeoff.h"

namespace pmdsim {

// Largest error beside edges against frame time, both logarithmic, with the fronts.
Canvas draw_tradeoff(const Tradeoff &tradeoff);

} // namespace pmdsim
