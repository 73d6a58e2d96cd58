#pragma once
// Setups for tests of tolerances, and a diode's change of one point's distance by its slope.

#include "engine/tolerance/diode_return.h"
#include "engine/tolerance/linear_theory.h"
#include "host/tolerance/diode_study.h"
#include "tests/support/scenes.h"

#include <numeric>

namespace pmdsim::test {

inline Setup setup_of(const Scene &scene, const Sensor &sensor, const std::vector<Illuminator> &illuminators,
                      Backscatter backscatter = Backscatter::lambert) {
  Setup setup;
  setup.backscatter = backscatter;
  setup.shadows = Shadows::automatic;
  setup.start.scene = scene;
  setup.start.sensors = {sensor};
  setup.start.illuminators = illuminators;
  return setup;
}

// Of these of the first sensor's pixels, in their order; all of them see something.
inline LitView view_of(const Setup &setup, const std::vector<std::uint32_t> &pixels) {
  std::vector<std::size_t> numbers;
  return lit_view(setup, setup.start.sensors[0], pixels, numbers);
}

inline std::vector<std::uint32_t> all_pixels(const Sensor &sensor) {
  std::vector<std::uint32_t> pixels(sensor.pixel_count());
  std::iota(pixels.begin(), pixels.end(), 0);
  return pixels;
}

// z of a point, term by term.
inline std::complex<double> z_of(const LitView &view, const LitPoint &point,
                                 const std::vector<TolerancedDiode> &diodes) {
  const Demodulation demodulation(view.waveform, view.taps);
  std::complex<double> z{};
  for (std::size_t m = 0; m < diodes.size(); ++m)
    if (point.is_reached_by(m))
      z += diode_return(view, demodulation, point, diodes[m]).z;
  return z;
}

inline double metres_per_radian(const LitView &view) { return view.metres_per_turn() / radians_per_turn; }

// The change of distance for an error, in its unit, m.
inline double slope_m(const LitView &view, const LitPoint &point, std::size_t diode, Fault fault) {
  if (!point.is_reached_by(diode))
    return 0.0;
  const DiodeReturn of =
      diode_return(view, Demodulation(view.waveform, view.taps), point, view.diodes[diode]);
  return metres_per_radian(view) *
         std::imag(of.slope[static_cast<std::size_t>(fault)] / z_of(view, point, view.diodes));
}

} // namespace pmdsim::test
