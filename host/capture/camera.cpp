#include "host/capture/camera.h"

#include "engine/electronics/electrons.h"
#include "engine/electronics/scatter.h"
#include "engine/model/channels.h"
#include "engine/model/error.h"
#include "engine/signal/unwrapping.h"
#include "host/capture/exposure.h"
#include "host/capture/progress.h"
#include "host/memory/byte_count.h"
#include "host/memory/machine_memory.h"
#include "host/memory/memory_limit.h"
#include "host/threads.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace pmdsim {

bool names_the_reference(const std::string &device) {
  return std::ranges::equal(device, std::string_view("reference"), {},
                            [](unsigned char c) { return std::tolower(c); });
}

namespace {

// Tells that a frame is nearly done, and lets it be stopped.
std::function<void()> progress_at_end(const Progress &progress) {
  if (!progress)
    return {};
  return [&progress] { progress(1.0); };
}

void set_extras(const Extras &extras, SimulatorOptions &options) {
  options.keep_sample_ids = extras.sample_triangles;
  options.keep_visibility = extras.reached;
  options.keep_taps = extras.taps;
  options.keep_unrounded = extras.unrounded;
  options.count_electrons = extras.electrons_at_once;
  options.allowed.complex_returns = !extras.electrons_of_polar;
  const PathForms all;
  options.allowed.point_polynomials = all.point_polynomials && !extras.diodes_in_a_loop;
  options.allowed.direct_pixels = all.direct_pixels && !extras.diodes_in_a_loop;
}

} // namespace

MemoryForecast forecast_of(const Setup &setup, const Sensor &sensor, const Extras &extras, MeasuredBy by,
                           std::size_t written_bytes, std::uint32_t max_strip_samples) {
  FrameToForecast frame{setup.start.scene,
                        sensor,
                        setup.start.illuminators,
                        setup.bounces,
                        bytes_of_frame(sensor, extras.taps, setup.bounces, {}, extras.unrounded),
                        by};
  if (setup.bounces.any() && by != MeasuredBy::reference)
    frame.elements = forecast_bounces(setup.start.scene, sensor, setup.bounces).elements;
  frame.frames_at_once = std::size_t{setup.frames.count} * setup.start.sensors.size() > 1 ? 2 : 1;
  frame.max_strip_samples = max_strip_samples;
  frame.is_written = true;
  frame.made_bytes = written_bytes - std::min(written_bytes, frame.frame_bytes);
  frame.moves = setup.motion != nullptr;
  return forecast_memory(frame);
}

Camera::Camera(const std::string &device, const Extras &extras) : extras_(extras), wanted_(device) {
  if (names_the_reference(device)) {
    device_ = "reference";
    driver_ = "pmdsim " PMDSIM_VERSION;
    return;
  }
  SimulatorOptions options;
  options.device = device;
  set_extras(extras, options);
  // The program never changes its environment any more.
  options.validation = validation_of(std::getenv("PMDSIM_VALIDATE")); // NOLINT(concurrency-mt-unsafe)
  const std::uint64_t taken_before = taken_memory();
  simulator_.emplace(options);
  settle_threads();
  const std::uint64_t taken = taken_memory();
  granted_bytes_ = std::min(taken - std::min(taken, taken_before), bytes_of_device);
  device_ = simulator_->device().name;
  driver_ = simulator_->device().driver;
}

MeasuredBy Camera::measured_by() const {
  if (!simulator_)
    return MeasuredBy::reference;
  return simulator_->device().kind == "discrete GPU" ? MeasuredBy::device_apart : MeasuredBy::device_in_host;
}

void Camera::give(const Extras &extras) {
  extras_ = extras;
  if (!simulator_)
    return;
  SimulatorOptions options = simulator_->options();
  set_extras(extras, options);
  simulator_->change(options);
}

void Camera::prepare(const Scene &scene, const Sensor &sensor, const std::vector<Illuminator> &illuminators,
                     Backscatter backscatter, Shadows shadows, const Accuracy &accuracy,
                     const Bounces &bounces) {
  throw_if_interrupted();
  sensor_ = sensor;
  ask_for_memory({scene, sensor, illuminators, bounces,
                  bytes_of_frame(sensor, extras_.taps, bounces, {}, extras_.unrounded), measured_by()});
  if (simulator_)
    return simulator_->prepare(scene, sensor, illuminators, backscatter, shadows, accuracy, bounces);
  const reference::Options options{.shadows = shadows, .bounces = bounces, .paths = extras_.paths};
  diode_count_ = static_cast<std::uint32_t>(diode_count(illuminators));
  reference_frame_ = [=, &scene](const Progress &progress) {
    return reference::simulate(scene, sensor, illuminators, backscatter, options, progress);
  };
}

std::uint64_t Camera::further_bytes(const MemoryForecast &frame) const {
  return frame.bytes() - std::min(granted_bytes_, frame.bytes());
}

// Strips become shorter before a frame is refused.
void Camera::ask_for_memory(FrameToForecast frame) {
  MemoryForecast forecast = forecast_memory(frame);
  std::optional<std::string> lack = lack_of_memory(further_bytes(forecast));
  if (lack && simulator_) {
    frame.max_strip_samples = short_strip_samples;
    forecast = forecast_memory(frame);
    lack = lack_of_memory(further_bytes(forecast));
  }
  if (lack)
    throw lacking_memory(frame.sensor, forecast, *lack);
  granted_bytes_ = std::max(granted_bytes_, forecast.bytes());
  if (!simulator_ || simulator_->options().max_strip_samples == frame.max_strip_samples)
    return;
  SimulatorOptions options = simulator_->options();
  options.max_strip_samples = frame.max_strip_samples;
  simulator_->change(options);
}

void Camera::prepare(const Setup &setup, const Sensor &sensor, const Accuracy &accuracy) {
  prepare(setup.start.scene, sensor, setup.start.illuminators, setup.backscatter, setup.shadows, accuracy,
          setup.bounces);
}

std::vector<std::pair<std::string, std::string>> Camera::path() const {
  return simulator_ ? simulator_->path() : std::vector<std::pair<std::string, std::string>>();
}

Measurement Camera::measure(const Progress &progress, const ExposureNumber &number, const AddLight &add) {
  Measurement measurement;
  if (is_reference() && sensor_.electronics && sensor_.scatter.empty() && !add) {
    throw_if_interrupted();
    const reference::Frame frame = reference_frame_(progress);
    measurement = measurement_of(frame, number);
    reference::count_electrons(frame, sensor_, extras_.taps, measurement, progress_at_end(progress));
  } else {
    measurement = measure_device(progress, number);
    add_and_scatter(add, measurement);
    if (sensor_.electronics && !measurement.has_electrons)
      count_electrons(sensor_,
                      {.reads_taps = static_cast<bool>(add),
                       .keep_taps = extras_.taps,
                       .between = progress_at_end(progress)},
                      measurement);
  }
  if (sensor_.unwrap_range_m > 0.0)
    unwrap_distances(sensor_, measurement);
  return measurement;
}

Measurement Camera::measure_noiseless(const Progress &progress, const ExposureNumber &number,
                                      const AddLight &add) {
  Measurement measurement = measure_light(progress, number);
  add_and_scatter(add, measurement);
  return measurement;
}

void Camera::add_and_scatter(const AddLight &add, Measurement &measurement) const {
  if (add && measurement.has_electrons)
    throw std::logic_error("light is added to a frame whose electrons are counted");
  if (add)
    add(measurement);
  if (sensor_.scatter.empty())
    return;
  const bool reads_taps = add || sensor_.waveform.kind != Waveform::Kind::sine;
  if (sensor_.electronics && !reads_taps) // electrons make new ones
    for (Return &of_frequency : measurement.returns)
      of_frequency.taps.clear();
  scatter(sensor_, measurement);
}

Measurement Camera::measure_light(const Progress &progress, const ExposureNumber &number) {
  Measurement measurement = measure_device(progress, number);
  if (measurement.has_electrons)
    throw std::logic_error("the light of a frame whose electrons are counted");
  return measurement;
}

Measurement Camera::measure_device(const Progress &progress, const ExposureNumber &number) {
  throw_if_interrupted();
  return simulator_ ? simulator_->measure(progress, number)
                    : measurement_of(reference_frame_(progress), number);
}

Measurement Camera::measurement_of(const reference::Frame &frame, const ExposureNumber &number) const {
  Measurement measurement = reference::to_measurement(frame);
  measurement.number = number;
  measurement.accuracy.precision = Precision::fp64;
  measurement.accuracy.diodes = diode_count_;
  if (!extras_.taps && !sensor_.electronics)
    for (Return &of_frequency : measurement.returns)
      of_frequency.taps.clear();
  if (!extras_.unrounded)
    for_each_unrounded(
        measurement, [](const ChannelIndex &, auto &, std::vector<double> &unrounded) { unrounded.clear(); });
  return measurement;
}

void Camera::give_up_device() {
  if (simulator_)
    simulator_->give_up_device();
}

void Camera::reuse(Measurement &&frame) {
  if (simulator_)
    simulator_->reuse(std::move(frame));
}

} // namespace pmdsim
