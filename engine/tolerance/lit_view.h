#pragma once
// The light of a frame as the study of tolerances has it: points, one for each pixel, and the diodes that
// light them. Plain data in the camera's frame (x right, y down, z forward, origin at the lens centre), SI
// units.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace pmdsim {

inline constexpr double radians_per_turn = 2.0 * std::numbers::pi;
inline constexpr double no_change = std::numeric_limits<double>::quiet_NaN(); // where no light returns

struct TolerancedDiode {
  Diode diode;                      // camera frame
  double phase_turns = 0.0;         // of its illuminator
  std::uint32_t illuminator = 0;    // its number
  glm::dmat3 illuminator_axes{1.0}; // columns: x, y, z of the illuminator
  glm::dvec3 towards_x, towards_y;  // unit length, across the axis: see toleranced()
};

// Of a diode in the camera's frame. `towards_x` is the part of the illuminator's x that lies across the axis,
// or of its y where x lies along it; `towards_y` is the axis times that.
TolerancedDiode toleranced(const Diode &diode, double phase_turns, std::uint32_t illuminator,
                           const glm::dmat3 &illuminator_axes);

// What a pixel sees.
struct LitPoint {
  glm::dvec3 position_m;
  glm::dvec3 normal; // unit length, turned to the lens
  double gain;       // reflectivity, times what vignetting leaves
  double weight =
      1.0; // of how many points of the image it is one: it counts for so many in all means over it
  // The diodes that reach it, as Measurement::sample_visibility has them; empty: all.
  std::vector<std::uint32_t> reached{};

  bool is_reached_by(std::size_t diode) const {
    return reached.empty() || (reached[diode / 32] >> diode % 32 & 1U) != 0;
  }
};

struct LitView {
  double modulation_hz = 20e6;
  Waveform waveform;
  std::uint32_t taps = 4;
  Backscatter backscatter = Backscatter::lambert;
  std::vector<TolerancedDiode> diodes; // through all illuminators
  std::vector<LitPoint> points;

  double turns_per_m() const { return modulation_hz / speed_of_light_m_s; }
  // Distance, m, for the phase of z, turns.
  double metres_per_turn() const { return speed_of_light_m_s / (2.0 * modulation_hz); }
};

} // namespace pmdsim
