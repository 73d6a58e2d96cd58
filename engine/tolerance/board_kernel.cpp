// Compiled once for each instruction set, PMDSIM_INSTRUCTION_SET its name; see engine/CMakeLists.txt.
#include "engine/tolerance/board_work.h"

#include "engine/model/wide_lanes.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

struct Phasor {
  Doubles re, im;
};

// (cos, sin) of 2 pi `turns`, of sizes up to 2^48, to 1e-13.
Phasor phasor_of(const Doubles &turns) {
  constexpr double shift = 0x1.8p52;
  const Doubles shifted = 4.0 * turns + shift, quarter = shifted - shift;
  const Doubles y = 6.283185307179586476925 * (turns - 0.25 * quarter), u = y * y; // at most pi/4
  const Doubles s =
      y * (1.0 + u * (-1.0 / 6.0 +
                      u * (1.0 / 120.0 +
                           u * (-1.0 / 5040.0 +
                                u * (1.0 / 362880.0 + u * (-1.0 / 39916800.0 + u * (1.0 / 6227020800.0)))))));
  const Doubles c =
      1.0 +
      u * (-0.5 + u * (1.0 / 24.0 +
                       u * (-1.0 / 720.0 + u * (1.0 / 40320.0 +
                                                u * (-1.0 / 3628800.0 + u * (1.0 / 479001600.0 +
                                                                             u * (-1.0 / 87178291200.0)))))));
  const Longs q = reinterpret_cast<Longs>(shifted); // its lowest bits are the quarter's number
  const Longs is_odd = (q & 1) != 0, is_turned = (q & 2) != 0;
  const Doubles re = is_odd ? -s : c, im = is_odd ? c : s;
  return {is_turned ? -re : re, is_turned ? -im : im};
}

Doubles whole_power(Doubles x, std::uint32_t power) {
  Doubles result = x * 0.0 + 1.0;
  for (; power > 0; power /= 2, x *= x)
    if (power % 2 == 1)
      result *= x;
  return result;
}

struct Term {
  Doubles weight, turns;
};

inline Term term_of(const BoardWork &board, const PointWork &point, std::size_t i) {
  const Doubles none = {}; // 0
  const Doubles x = load<Doubles>(board.x_m + i) - point.x_m, y = load<Doubles>(board.y_m + i) - point.y_m,
                z = load<Doubles>(board.z_m + i) - point.z_m;
  const Doubles square = x * x + y * y + z * z, range = root(square), per_range = 1.0 / range;
  const Doubles incidence = (point.normal_x * x + point.normal_y * y + point.normal_z * z) * per_range;
  Doubles weight = load<Doubles>(point.reach + i) * load<Doubles>(board.intensity_w_sr + i) * point.gain *
                   per_range * per_range;
  weight = incidence > none ? (point.is_lambert ? weight * incidence : weight) : none;
  if (board.relative)
    weight *= load<Doubles>(board.relative + i);
  else if (!board.is_isotropic) {
    const Doubles cosine = -(load<Doubles>(board.axis_x + i) * x + load<Doubles>(board.axis_y + i) * y +
                             load<Doubles>(board.axis_z + i) * z) *
                           per_range;
    weight = cosine > none ? weight * whole_power(cosine, board.order) : none;
  }
  return {weight, board.turns_per_m * (range + point.lens_path_m) + load<Doubles>(board.phase_turns + i)};
}

void sum(const BoardWork &board, const PointWork &point, double &re, double &im) {
  Doubles sum_re = {}, sum_im = {};
  for (std::size_t i = 0; i < board.count; i += double_lanes) {
    const Term term = term_of(board, point, i);
    const Phasor phasor = phasor_of(term.turns);
    sum_re += term.weight * phasor.re;
    sum_im += term.weight * phasor.im;
  }
  re = im = 0.0;
  for (int lane = 0; lane < double_lanes; ++lane) {
    re += sum_re[lane];
    im += sum_im[lane];
  }
}

void terms(const BoardWork &board, const PointWork &point, double *weights, double *turns) {
  for (std::size_t i = 0; i < board.count; i += double_lanes) {
    const Term term = term_of(board, point, i);
    store(weights + i, term.weight);
    store(turns + i, term.turns);
  }
}

} // namespace

const BoardLoops board_loops{sum, terms};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
