#pragma once
// What the loops over a board's diodes are told, in arrays of `count` values, a multiple of 8; behind the
// last diode are such of no intensity. Frames and units as in lit_view.h.

#include "engine/model/instruction_sets.h"

#include <cstddef>
#include <cstdint>

namespace pmdsim {

struct BoardWork {
  std::size_t count;
  const double *x_m, *y_m, *z_m, *axis_x, *axis_y, *axis_z, *intensity_w_sr, *phase_turns;
  bool is_isotropic;      // J is 1, else the cosine to a whole power
  std::uint32_t order;    // that
  const double *relative; // J of each diode towards the point, instead of both; or nullptr
  double turns_per_m;
};

struct PointWork {
  double x_m, y_m, z_m, normal_x, normal_y, normal_z;
  double gain;         // over pi for Lambert's backscatter
  bool is_lambert;     // else the cosine of incidence counts only by its sign
  double lens_path_m;  // to the lens
  const double *reach; // 1 where a diode reaches it, else 0
};

struct BoardLoops {
  // z of a sine.
  void (*sum)(const BoardWork &board, const PointWork &point, double &re, double &im);
  // Weight and phase of each diode, `count` values each.
  void (*terms)(const BoardWork &board, const PointWork &point, double *weights, double *turns);
};

} // namespace pmdsim

PMDSIM_LOOPS_OF_EACH_SET(BoardLoops, board_loops)
