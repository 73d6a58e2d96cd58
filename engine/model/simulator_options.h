#pragma once
// How the simulator runs, as opposed to what it computes: none of these changes a result beyond its stated
// error.

#include <cstdint>
#include <string>

namespace pmdsim {

// The arithmetic of what is done once a sample: fp64 where the device has it, or pairs of floats anywhere.
enum class SamplePrecision { automatic, double_float };
// The shape of the accumulate pass: a straight line for CPUs, a loop for GPUs.
enum class DiodeLoop { automatic, straight_line, looped };

// How the diodes are summed where there is a choice: by moments wherever the waveform allows, or always diode
// by diode.
enum class DiodeSum { automatic, direct };

struct SimulatorOptions {
  std::string device; // an index or a part of a name; empty: a discrete GPU, else whatever there is
  std::uint32_t max_strip_samples = 0; // of a strip, which has at least one row; 0: chosen by the simulator
  bool keep_sample_tags = false;       // fill Measurement::sample_triangle_id and sample_pixel_id
  bool keep_reached = false;           // fill Measurement::sample_reached
  bool keep_taps = false;              // fill Return::taps
  bool validate = false; // run under the Khronos validation layer; a message is a std::logic_error
  SamplePrecision precision = SamplePrecision::automatic;
  DiodeLoop loop = DiodeLoop::automatic;
  DiodeSum sum = DiodeSum::automatic;
};

} // namespace pmdsim
