#include "host/bench/native/race.h"

#include "host/capture/camera.h"
#include "host/input/setup/sample_choice.h"
#include "host/report/field_of_view.h"

#include <cmath>

namespace pmdsim {
namespace {

// Enough for every thread, and little enough to be run in every round.
constexpr double most_interactions = 2e8;

ChosenWork work_of(const Setup &setup, const std::string &device) {
  const auto &[scene, sensors, illuminators] = setup.start;
  Sensor sensor = sensors.front();
  set_samples(sensor, {.samples = 1});
  const double interactions =
      static_cast<double>(sensor.pixel_count()) * static_cast<double>(diode_count(illuminators));
  sensor = coarser(sensor, std::sqrt(interactions / most_interactions));
  Camera camera(device);
  camera.prepare(scene, sensor, illuminators, setup.backscatter, setup.shadows);
  return native_work(setup, sensor, camera.measure());
}

} // namespace

NativeBench::NativeBench(const Setup &setup, const std::string &device)
    : checked_(checked_kernel(work_of(setup, device), *available_native_sums().front(), native_threads())) {}

void NativeBench::run() {
  moments_per_s_.push_back(rate(NativeForm::moments));
  if (checked_.series_error_m)
    series_per_s_.push_back(rate(NativeForm::series));
}

double NativeBench::rate(NativeForm form) {
  checked_.kernel.run_s(form);
  return checked_.kernel.interactions() / checked_.kernel.run_s(form);
}

} // namespace pmdsim
