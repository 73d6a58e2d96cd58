#pragma once
// The light that arrives along a line over a hemisphere: what faces send, turned by the ways from there.

#include "engine/radiosity/face_light.h"
#include "engine/surfaces/scan_board.h"

namespace pmdsim {

// Of each bin, the share that its face has in what arrives, turned by the length of the way.
struct LineWays {
  alignas(64) float re[most_bins], im[most_bins];
};

// Sums over a line.
struct LineLight {
  Phasor arrives;
  Phasor along; // each bin's part times the cotangent of its angle from the axis
};

// Compiled for several instruction sets; with each the sums are the same.
struct LineLightLoops {
  void (*find_ways)(const SeenLine &line, double turns_per_m, LineWays &ways);
  LineLight (*add_light)(const SeenLine &line, const LineWays &ways, const FaceLight *faces);
};

// Those for the widest vectors that the processor has.
const LineLightLoops &line_light_loops();

} // namespace pmdsim
