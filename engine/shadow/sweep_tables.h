#pragma once
// The sweep's tables of a window's diodes on a flat board: which lie within an angle, and beyond a line.

#include "engine/shadow/boards.h"
#include "shaders/shadow/sweep_interface.h"

#include <vector>

namespace pmdsim {

struct SweepTables {
  bool tells_angles = true; // else diodes stand so close that `ranks` cannot tell some of their angles apart
  std::vector<shader::uvec4> ranks; // of each bin of angles: three ranks of 10 bits, the angles between them
  std::vector<shader::uvec4> prefixes; // of each rank, two: the diodes of smaller angles, a bit each
  std::vector<shader::uvec4> lines; // of each direction and offset, four: pairs of surely beyond and perhaps
  std::vector<shader::vec4> diodes; // two of each: x, y, their rests; z, its rest. Board frame, m
};

// Diodes whose angles about the board's centre (engine/model/turn.h) differ by no more count as of one angle.
constexpr float same_turn = 1e-6f;

// The distance by which a line on the board may be off for `lines` to be right, m.
double line_margin_m(const Board &board);

// `places_m` as places_of() gives them.
SweepTables sweep_tables(const Board &board, const std::vector<glm::dvec3> &places_m);

} // namespace pmdsim
