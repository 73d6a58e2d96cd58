#pragma once
// The benchmark's sweep: how the time of a frame grows with each quantity. Its setups are made in memory: the
// paper's ring and wall (scenes/paper_ring.json) with one quantity changed at a time.

#include "host/bench/accuracy_check.h"
#include "host/bench/timing.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pmdsim {

enum class SweptQuantity { resolution, diodes, samples, triangles, frequencies };

struct SweptRow {
  std::string name; // "resolution"
  std::string unit; // what the time of a frame may be expected to grow with: "pixels", "diodes", ...
  bool squared;     // whether there are as many of these as the value's square
  std::vector<std::uint32_t> values; // columns and rows, diodes, S, triangles, frequencies; ascending
};
const SweptRow &row_of(SweptQuantity quantity);

struct SweepPoint {
  SweptQuantity quantity;
  std::uint32_t value;

  std::string name() const; // "resolution 160"
  double units() const;
};

// The points of each quantity.
std::vector<std::vector<SweepPoint>> all_sweeps();

// A wall of 0.4 x 0.4 m that fills the view of 640 x 640 pixels at 2 m, lit by 240 isotropic diodes in five
// rings; constant backscatter, one sample a pixel, 20 MHz.
Setup paper_ring();

// The paper's ring with the point's value in place of its own. More pixels are smaller, diodes share the
// rings' radii, triangles are a grid on the wall (their number even, and a rectangle's), frequencies are 2.5
// MHz apart.
Setup swept_setup(const SweepPoint &point);

struct SizeAndTime {
  double size, ms;
};

// ms = fixed_ms + slope_ms * size, with the least squares of relative errors and no part below 0.
struct StraightLine {
  double fixed_ms = 0.0, slope_ms = 0.0;

  double at_ms(double size) const { return fixed_ms + slope_ms * size; }
};

// The fit to at least one point of positive size and time; that to a single point has no fixed part.
StraightLine straight_line(std::span<const SizeAndTime> points);

struct SweepRow {
  SweepPoint point;
  double first_frame_ms = 0.0; // from preparing to the result, with all compiling
  double prepare_ms = 0.0;     // again, warm; median
  double error_m = 0.0;        // largest at random pixels and all frequencies, against the reference
  std::size_t checked_pixels = 0;
  double interactions = 0.0;                     // samples x diodes
  std::optional<std::int64_t> peak_memory_bytes; // of the process, while the row was first measured
  std::vector<TimedFrame> frames;
};

// The largest error of distance at some random pixels of a frame of the setup's first sensor, wrapped, and
// their number. Throws Error (internal) where it is larger than rounding and the error claimed explain.
struct RandomCheck {
  double error_m = 0.0;
  std::size_t pixels = 0;
};
RandomCheck check_at_random(const Setup &setup, const Measurement &found, const std::string &device);

// Every point in one mode, exact unless another one is asked for; the points of each sweep in turn. Throws
// Error.
std::vector<SweepRow> run_sweep(const std::vector<std::vector<SweepPoint>> &sweeps,
                                const BenchRequest &request);

// How one quantity's frame times grow: the median of each point. (Where a clock has a slow and a fast mode,
// short frames have their least in the fast one, long ones in both.)
struct Growth {
  SweptQuantity quantity;
  std::vector<SizeAndTime> points;
  StraightLine line;
  std::vector<double>
      marginal_ms; // beside the points: more than the one before took, a unit of size; NaN first
};
std::vector<Growth> growths_of(const std::vector<SweepRow> &rows);

} // namespace pmdsim
