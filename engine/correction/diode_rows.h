#pragma once
// The diodes as the loops over them read them: in the camera frame, in rows of one radiation law each.

#include "engine/model/illuminator.h"
#include "engine/model/sensor.h"

#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

namespace pmdsim {

inline constexpr double radians_per_turn = 2.0 * std::numbers::pi;

enum class DiodeLaw { isotropic, whole_order, order, diagram };

// A row has a multiple of `row_step` diodes; those that fill it up are dark.
inline constexpr std::size_t row_step = 8;

struct DiodeRow {
  DiodeLaw law = DiodeLaw::isotropic;
  double order = 0.0;
  std::shared_ptr<const Diagram> diagram{};
  // Position in metres, unit axis, and for diagrams where phi is 0.
  std::vector<double> x{}, y{}, z{}, axis_x{}, axis_y{}, axis_z{}, across_x{}, across_y{}, across_z{};
  std::vector<double> intensity_w_sr{}, phase_turns{};

  std::size_t size() const { return x.size(); }
};

// What a camera takes for the return of a path of the phase x: a sine exp(j x); square light and harmonics by
// its taps, (2/N) sum_k C(x - 2 pi k / N) exp(j 2 pi k / N).
struct TapDemodulation {
  enum class Kind { sine, harmonics, square };
  Kind kind = Kind::sine;
  // Harmonics: a_h of exp(j h x), where h = 1 modulo N, and of exp(-j h x), where h = -1 modulo N; by h, from
  // 0 on.
  std::vector<double> forward{}, backward{};
  std::vector<double> tap_cos{}, tap_sin{}; // square: (2/N) exp(j 2 pi k / N)
};

std::vector<DiodeRow> diode_rows(const Sensor &sensor, const std::vector<Illuminator> &illuminators);
TapDemodulation demodulation_of(const Sensor &sensor);

} // namespace pmdsim
