#pragma once
// The loops over the diodes, compiled for each instruction set.

#include "engine/correction/diode_rows.h"
#include "engine/model/instruction_sets.h"

#include <complex>
#include <glm/glm.hpp>

namespace pmdsim {

// A point at `range_m` along a unit ray of the camera frame, on a surface with a unit normal to the lens.
struct PointOnRay {
  glm::dvec3 ray;
  double range_m;
  glm::dvec3 normal;
};

// The model's return there, for rho (or rho/pi) of 1, W/m^2 by sr: z of eq. 7.
struct ModelReturn {
  std::complex<double> z;
  std::complex<double> per_m;         // dz/dr by the paths' phases, with the weights held
  std::complex<double> per_normal[3]; // dz/dn by the weights, where it is asked for; else 0
};

struct ReturnWork {
  const std::vector<DiodeRow> &rows;
  const TapDemodulation &demodulation;
  double turns_per_m; // of the path: f / c
  bool lambert;       // else a surface that faces a diode scatters evenly
};

// The mean over the diodes is taken of nothing: sums, in the order of the rows.
using ReturnLoop = void (*)(const ReturnWork &of, const PointOnRay &at, bool with_normal, ModelReturn &sum);

struct ReturnLoops {
  ReturnLoop sum;
};

} // namespace pmdsim

PMDSIM_LOOPS_OF_EACH_SET(ReturnLoops, return_loops)
