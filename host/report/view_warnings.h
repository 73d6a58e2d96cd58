#pragma once
// What is odd about what a sensor sees, in the same words before a frame is measured and after it.

#include "engine/model/sensor.h"
#include "engine/model/warning.h"
#include "host/input/setup/setup.h"

#include <string>

namespace pmdsim {

// Of a sensor that sees nothing of the scene; `place` is what the warning is about.
Warning nothing_in_view(const Setup &setup, const Sensor &sensor, const std::string &place);

// Of what a sensor sees from `min_m` to `max_m`, the share of it, 0 to 1, that lies beyond `ambiguity_m`.
struct BeyondAmbiguity {
  double min_m, max_m, share, ambiguity_m;
};
Warning beyond_ambiguity(const Setup &setup, const BeyondAmbiguity &beyond, const std::string &place);

// Whether loading the setup has warned of it.
bool has_warned_of(const Setup &setup, std::string_view code);

} // namespace pmdsim
