#include "engine/frame/frame.h"

#include "engine/error_budget/plan.h"
#include "engine/shadow/visibility_bits.h"
#include "engine/signal/read_back.h"

#include <algorithm>
#include <bit>
#include <chrono>

namespace pmdsim {

Frame::Frame(const vulkan::Device &device, const SimulatorOptions &options, const FrameRequest &request,
             std::uint32_t attempt, TextureCache &textures, SpareMemory &&spare)
    : options_(options), shadows_(request.shadows), accuracy_(request.accuracy),
      on_(make_passes(device, options, request, attempt, textures, std::move(spare))) {}

void Frame::warm_up(vulkan::PassRecorder &recorder) const {
  on_.graph.warm_up(recorder, on_.strips.front(), on_.windows);
}

void Frame::clear_violations(vulkan::PassRecorder &recorder) const {
  recorder.begin();
  recorder.commands().fillBuffer(on_.memory->buffers.violations.get(), 0, sizeof(shader::BudgetViolations),
                                 0);
  recorder.finish();
}

// The part left to the host: frames in which nothing stands in any light, and samples that see nothing.
void Frame::finish_visibility(Measurement &measurement) const {
  if (on_.path.windows == 0) {
    measurement.lit.resize(measurement.coverage.size());
    std::ranges::transform(measurement.coverage, measurement.lit.begin(),
                           [](float coverage) { return coverage > 0.0f ? 1.0f : 0.0f; });
    full_visibility(*on_.sources, measurement.sample_visibility);
  }
  if (!measurement.sample_visibility.empty())
    clear_unseen(measurement);
}

// The joint claim of the pixels that keep what was asked for, and the number of returns that do not.
void Frame::finish_claims(Measurement &measurement) const {
  const shader::BudgetViolations words = budget_violations(on_.memory->buffers);
  AccuracyReport &report = measurement.accuracy;
  report.unpromised = words.returns;
  report.claimed_m = static_cast<double>(std::bit_cast<float>(words.kept_m));
  report.claimed_amplitude = static_cast<double>(std::bit_cast<float>(words.kept_amplitude));
}

void Frame::check_strip(vulkan::PassRecorder &recorder, std::size_t strip, Measurement &measurement) const {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<PassTime> times = recorder.times();
  const PlannedStrip &planned = on_.strips[strip];
  on_.check_graph.run(recorder, planned, strip, on_.windows, {}, measurement);
  recorder.reset(times);
  on_.check->compare(strip, planned.strip, on_.memory->buffers, accuracy_.max_error_m, measurement);
  measurement.accuracy.check_ms += vulkan::milliseconds_since(start);
}

Measurement Frame::measure(vulkan::PassRecorder &recorder, Measurement &&memory,
                           const std::function<void(double)> &progress, const ExposureNumber &number) const {
  const auto start = std::chrono::steady_clock::now();
  recorder.reset();
  Measurement measurement = make_measurement(on_.sensor, on_.modulation, options_, std::move(memory));
  const double memory_ms =
      vulkan::milliseconds_since(start); // long for a first frame, to which the system gives the memory
  measurement.number = number;
  measurement.accuracy = on_.report;
  const bool shaded = shadows_ == Shadows::automatic;
  if (!shaded)
    measurement.lit.clear();
  else if (options_.keep_visibility)
    measurement.sample_visibility = no_visibility(on_.sensor, *on_.sources);
  if (on_.modulation.keeps_terms)
    clear_violations(recorder);
  for (std::size_t i = 0; i < on_.strips.size(); ++i) {
    const auto of_strip = [&](double fraction) {
      if (progress)
        progress((static_cast<double>(i) + fraction) / static_cast<double>(on_.strips.size()));
    };
    on_.graph.run(recorder, on_.strips[i], i, on_.windows, of_strip, measurement);
    of_strip(1.0);
    if (on_.check)
      check_strip(recorder, i, measurement);
  }
  if (shaded)
    finish_visibility(measurement);
  if (on_.modulation.reports_kept && accuracy_.mode != Mode::exact)
    finish_claims(measurement);
  recorder.add("read_back", memory_ms);
  measurement.passes = recorder.times();
  measurement.frame_ms = vulkan::milliseconds_since(start) - measurement.accuracy.check_ms;
  return measurement;
}

std::optional<std::string> Frame::beyond_bound() const {
  if (accuracy_.mode == Mode::exact)
    return std::nullopt;
  return pmdsim::beyond_bound(budget_violations(on_.memory->buffers), accuracy_);
}

std::optional<std::string> Frame::beyond_check(const Measurement &measured) const {
  if (accuracy_.mode == Mode::exact)
    return std::nullopt;
  return pmdsim::beyond_check(measured.accuracy, accuracy_, on_.sensor.ambiguity_m());
}

bool Frame::is_most_exact() const {
  const PixelClass &last = on_.path.classes.back();
  return !last.reduced && (last.precision == Precision::fp64 || !on_.modulation.by_moments());
}

} // namespace pmdsim
