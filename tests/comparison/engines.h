#pragma once
// Every analytic case runs on both the CPU reference and the Vulkan device, and says so in a table.

#include "engine/model/illuminator.h"
#include "engine/model/measurement.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"
#include "engine/model/simulator_options.h"

#include <string>

namespace pmdsim::test {

enum class Engine { reference, vulkan };

std::string name_of(Engine engine);

// Runs the rest of a test case once with each.
Engine both_engines();

// The options are the simulator's; the reference heeds `keep_visibility` only, and gives the samples'
// triangles and the taps always.
Measurement measure(Engine engine, const Scene &scene, const Sensor &sensor, const Illuminator &illuminator,
                    Backscatter backscatter, const SimulatorOptions &options = {},
                    Shadows shadows = Shadows::off);

Measurement measure(Engine engine, const Scene &scene, const Sensor &sensor,
                    const std::vector<Illuminator> &illuminators, Backscatter backscatter,
                    const SimulatorOptions &options = {}, Shadows shadows = Shadows::off);

// Under light in the lens.
Measurement measure_monostatic(Engine engine, const Scene &scene, const Sensor &sensor,
                               Backscatter backscatter = Backscatter::constant,
                               const SimulatorOptions &options = {});

// Each prints a line of the table and checks `got`: a distance to max(2 micrometres, 1e-7 * true distance) of
// the true distance, both wrapped to the ambiguity; an amplitude, or a ratio of two, to 1e-5 of it.
void check_distance(Engine engine, const std::string &name, double true_m, const Sensor &sensor, float got_m,
                    std::size_t frequency = 0);
void check_amplitude(Engine engine, const std::string &name, double expected, double got);

// Prints a line of the table and checks `got` to `tolerance`, in the unit that the name says.
void check_within(Engine engine, const std::string &name, double expected, double got, double tolerance);

} // namespace pmdsim::test
