#pragma once
// The ways in which a diode may differ from the one that a setup describes, and how far.

#include <array>
#include <cstddef>
#include <numbers>

namespace pmdsim {

// One way each. Along the axes of the diode's illuminator: its place; the tilt of its axis towards them, as
// TolerancedDiode has it; its intensity; its modulation's phase; and no light at all.
enum class Fault { x, y, z, axis_x, axis_y, intensity, phase, dead };
inline constexpr std::size_t fault_count = 8, slope_count = fault_count - 1; // those but `dead` have a slope

// As files and tables name them.
inline constexpr std::array<const char *, fault_count> fault_names{"x",      "y",         "z",     "axis_x",
                                                                   "axis_y", "intensity", "phase", "dead"};

// What is told of a board apart: the faults that have a tolerance in common.
enum class Kind { position, axis, intensity, phase, dead };
inline constexpr std::size_t kind_count = 5;
inline constexpr std::array<const char *, kind_count> kind_names{"position", "axis", "intensity", "phase",
                                                                 "dead"};

constexpr Kind kind_of(Fault fault) {
  constexpr std::array of{Kind::position, Kind::position,  Kind::position, Kind::axis,
                          Kind::axis,     Kind::intensity, Kind::phase,    Kind::dead};
  return of[static_cast<std::size_t>(fault)];
}

// Gaussian: the tolerance is the standard deviation. Uniform: within plus and minus the tolerance.
enum class ErrorLaw { gaussian, uniform };

// How far each diode of a board is off, independently of all others.
struct Tolerances {
  double position_m = 1e-4;                    // along each of x, y and z
  double axis_rad = std::numbers::pi / 180.0;  // towards each of the two directions across the axis
  double intensity = 0.05;                     // of itself
  double phase_rad = std::numbers::pi / 180.0; // at the modulation frequency
  double dead = 0.01;                          // the chance of it
  ErrorLaw law = ErrorLaw::gaussian;

  // Of an error, over the square of its tolerance.
  constexpr double error_variance() const { return law == ErrorLaw::uniform ? 1.0 / 3.0 : 1.0; }
  // By the kind's own unit.
  constexpr double of(Kind kind) const {
    return std::array{position_m, axis_rad, intensity, phase_rad, dead}[static_cast<std::size_t>(kind)];
  }
};

} // namespace pmdsim
