#include "engine/reference/reference.h"
#include "host/tolerance/diode_study.h"

#include <cmath>
#include <numbers>

namespace pmdsim {
namespace {

// The directions of `illuminator` in the sensor's frame, and its diodes there.
void add_diodes(const Illuminator &illuminator, std::uint32_t number, const Sensor &sensor,
                std::vector<TolerancedDiode> &diodes) {
  const Pose camera_from_illuminator =
      compose(inverse(sensor.world_from_camera), illuminator.world_from_illuminator);
  const double phase_turns = illuminator.modulation_phase_rad / (2.0 * std::numbers::pi);
  for (const Diode &in_illuminator : illuminator.diodes) {
    Diode diode = in_illuminator;
    diode.position_m = camera_from_illuminator.point(diode.position_m);
    diode.axis = camera_from_illuminator.direction(diode.axis);
    diode.across = camera_from_illuminator.direction(diode.across);
    diodes.push_back(toleranced(diode, phase_turns, number, camera_from_illuminator.rotation));
  }
}

} // namespace

LitView lit_view(const Setup &setup, const Sensor &of, const std::vector<std::uint32_t> &pixels,
                 std::vector<std::size_t> &numbers, const std::function<void(double)> &progress) {
  Sensor sensor = of; // of which only geometry is asked
  sensor.samples = 1;
  sensor.modulation_hz.resize(1);
  sensor.waveform = {};
  sensor.electronics.reset();
  const std::vector<Illuminator> &illuminators = setup.start.illuminators;
  const reference::Frame frame =
      reference::simulate(setup.start.scene, sensor, illuminators, setup.backscatter,
                          {.shadows = setup.shadows,
                           .keep_visibility = setup.shadows == Shadows::automatic,
                           .pixels = pixels,
                           .keep_points = true},
                          progress);
  LitView view;
  view.modulation_hz = of.modulation_hz.front();
  view.waveform = of.waveform;
  view.taps = of.taps;
  view.backscatter = setup.backscatter;
  for (std::uint32_t i = 0; i < illuminators.size(); ++i)
    add_diodes(illuminators[i], i, of, view.diodes);
  const auto words = static_cast<std::ptrdiff_t>((view.diodes.size() + 31) / 32);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto &point = frame.sample_points[i];
    if (!point)
      continue;
    LitPoint &lit = view.points.emplace_back(
        LitPoint{point->position_m, point->normal, point->reflectivity * point->lens_gain});
    if (const auto first = frame.sample_visibility.begin() + static_cast<std::ptrdiff_t>(i) * words;
        !frame.sample_visibility.empty())
      lit.reached.assign(first, first + words);
    numbers.push_back(i);
  }
  return view;
}

} // namespace pmdsim
