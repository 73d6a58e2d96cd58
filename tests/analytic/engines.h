#pragma once
// Every analytic case runs on both the CPU reference and the Vulkan device, and says so in a table.

#include "engine/illuminator.h"
#include "engine/measurement.h"
#include "engine/scene.h"
#include "engine/sensor.h"

#include <string>

namespace pmdsim::test {

enum class Engine { reference, vulkan };

Measurement measure(Engine engine, const Scene &scene, const Sensor &sensor, const Illuminator &illuminator,
                    Backscatter backscatter);

// Each prints a line of the table and checks `got`: a distance to max(2 micrometres, 1e-7 * true distance) of
// the true distance, both wrapped to the ambiguity; an amplitude, or a ratio of two, to 1e-5 of it.
void check_distance(Engine engine, const std::string &name, double true_m, const Sensor &sensor, float got_m);
void check_amplitude(Engine engine, const std::string &name, double expected, double got);

} // namespace pmdsim::test
