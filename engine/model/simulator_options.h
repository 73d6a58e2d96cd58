#pragma once
// How the simulator runs, as opposed to what it computes: none of these changes a result beyond its stated
// error.

#include <cstdint>
#include <string>
#include <string_view>

namespace pmdsim {

// The arithmetic of the work done once a sample: fp64 where the device has it, or pairs of floats anywhere.
enum class SamplePrecision { automatic, double_float };
// The shape of the accumulate pass: a straight line for CPUs, a loop for GPUs.
enum class DiodeLoop { automatic, straight_line, looped };

// What Vulkan's validation layer looks at: nothing; every call and all synchronization; or also, by code that
// it adds to the shaders, which addresses and array elements they reach.
enum class Validation { none, calls, calls_and_shaders };

// As the environment variable PMDSIM_VALIDATE says it, if it is set: "1" or "gpu".
inline Validation validation_of(const char *value) {
  const std::string_view wanted = value ? value : "";
  return wanted == "gpu" ? Validation::calls_and_shaders
         : wanted == "1" ? Validation::calls
                         : Validation::none;
}

// Forms of a frame's path that are faster where a setup allows them. Each may be forbidden, so that tests and
// benchmarks see a frame with it and without. None changes a result beyond the frame's stated error.
struct PathForms {
  bool polynomial_moments = true;     // moments from powers of r_nm^2 - rho^2
  bool equal_weights = true;          // sources of one weight, which are there as positions alone
  bool coplanar = true;               // sources in a plane across the view
  bool point_polynomials = true;      // sums over the diodes, beforehand, as polynomials of the point
  bool depth_records = true;          // a sample's ID and depth in place of its point
  bool one_backscatter = true;        // of all that is seen, not looked up
  bool direct_pixels = true;          // from depth records to channels at once
  bool uniform_pixels = true;         // from IDs to channels at once
  bool uniform_single_samples = true; // the same where pixels have one sample
  bool refined_uniform_pixels = true; // at four points of a pixel
  bool host_raster = true;            // of IDs, where the device is the host's processor
  bool unsorted = true;               // within an error all pixels from depth records, in place of classes
  bool host_sweep = true;             // and claims: on the host, where the device is its processor
  bool host_sum = true;               // of depth records that are not summed beforehand, likewise
  bool host_pixels = true;            // from depth records to channels at once, likewise
  bool incident_field = true;         // within an error, the sums of those between nodes, not at each
  bool complex_returns = true;        // of which a strip's electrons are counted, not of amplitude and phase
};

struct SimulatorOptions {
  std::string
      device; // an index, a part of a name, "cpu" or "gpu"; empty: a discrete GPU, else whatever there is
  std::uint32_t max_strip_samples = 0; // of a strip, which has at least one row; 0: chosen by the simulator
  bool keep_sample_ids = false;        // fill Measurement::sample_triangle_id and sample_pixel_id
  bool keep_visibility = false;        // fill Measurement::sample_visibility
  bool keep_taps = false;              // fill Return::taps
  bool keep_unrounded = false;         // fill Return::unrounded_distance_m and the like
  // The frame's last pass counts the electrons of a sensor with electronics (Measurement::has_electrons), in
  // mode exact, without bounces, and where counts_by_strips() of engine/electronics/electrons.h says so.
  bool count_electrons = false;
  bool keep_error_bound = false;            // fill Return::error_bound_m wherever an error was asked for
  Validation validation = Validation::none; // by the Khronos layer; a message is a std::logic_error
  SamplePrecision precision = SamplePrecision::automatic;
  DiodeLoop loop = DiodeLoop::automatic;
  std::uint32_t host_vector_bits = 512; // of the host's loops, at most
  PathForms allowed{};
};

} // namespace pmdsim
