#pragma once
// What errors of diodes do to the distances of one sensor at one frequency: the figures that tables and
// pictures show.

#include "engine/tolerance/linear_theory.h"
#include "engine/tolerance/monte_carlo.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace pmdsim {

inline constexpr double um_per_m = 1e6; // files and tables have micrometres

struct StudiedDiode {
  std::string illuminator;
  std::size_t number = 0;      // in it, from 0
  glm::dvec3 position_m{0.0};  // illuminator frame
  glm::dvec3 in_camera_m{0.0}; // camera frame
};

// Random boards, at some of the points.
struct RandomBoards {
  std::uint32_t boards = 0;
  std::uint64_t seed = 0;
  std::vector<std::size_t> points{}; // their numbers
  std::vector<double> weights{};     // of how many points of the image each is one
  // By kind, and all together: what theory says of these points, and what was found.
  BoardDeviation theory{};
  std::array<BoardStatistics, kind_count + 1> found{};
  std::vector<double> theory_m{};            // of each point, all together
  std::vector<PointStatistics> statistics{}; // likewise
};

struct DiodeStudy {
  std::string sensor;
  double modulation_hz = 0.0;
  glm::uvec2 resolution{0, 0}; // of the sensor
  glm::uvec2 grid{0, 0};       // columns and rows of the pixels that were looked at
  Tolerances tolerances{};
  std::vector<std::string> illuminators{}; // their names
  std::vector<StudiedDiode> diodes{};
  std::vector<glm::uvec2> pixels{}; // column and row of each point
  std::vector<std::size_t> cells{}; // its place in the grid, row-major
  LinearTheory theory{};
  RandomBoards random{};

  // A diode's part in what boards differ by at the offset, or at all where nothing varies over the image.
  double part_m(std::size_t diode) const;
  // Diodes by that, the largest first.
  std::vector<std::size_t> ranking() const;
  // Of a value of each point the image of the sensor, row-major: each pixel has that of the pixel nearest to
  // it that was looked at, NaN where that sees nothing.
  std::vector<float> image_of(const std::vector<double> &values, double factor) const;
};

// "ring 12".
std::string diode_name(const StudiedDiode &diode);

// "0.1 mm", "1 deg", "5 %".
std::string tolerance_text(Kind kind, const Tolerances &tolerances);

// "x", "axis towards y", "intensity".
std::string fault_text(Fault fault);

} // namespace pmdsim
