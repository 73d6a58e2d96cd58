#include "engine/radiosity/line_light.h"

#include "engine/model/instruction_sets.h"

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::LineLightLoops, loops_of_line_light)

namespace pmdsim {

const LineLightLoops &line_light_loops() { return widest_loops_of_line_light(512); }

} // namespace pmdsim
