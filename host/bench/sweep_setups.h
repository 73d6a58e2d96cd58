#pragma once
// The setups of the benchmark's sweep, made in memory: the paper's ring and wall (scenes/paper_ring.json)
// with one quantity changed at a time.

#include "host/input/setup/setup.h"

#include <cstdint>
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

// That with the point's value in place of its own. More pixels are smaller, diodes share the rings' radii,
// triangles are a grid on the wall (their number even, and a rectangle's), frequencies are 2.5 MHz apart.
Setup swept_setup(const SweepPoint &point);

} // namespace pmdsim
