#include "engine/simulator.h"

#include "engine/error_budget/budget.h"
#include "engine/frame/frame_passes.h"
#include "engine/model/error.h"
#include "engine/shadow/visibility_bits.h"
#include "engine/signal/read_back.h"
#include "engine/vulkan/device_choice.h"
#include "engine/vulkan/pass_recorder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <variant>

namespace pmdsim {
namespace {

// One submission's work at most: a frame can be stopped, shows its progress and holds no GPU for more than
// 100 ms (at 5e9 interactions a second, a tenth of what a small one does).
constexpr std::uint64_t interactions_per_submission = 500'000'000;

DeviceInfo choose(const vulkan::Instance &instance, const std::string &wanted) {
  std::vector<DeviceInfo> devices;
  for (const auto &device : instance.devices())
    devices.push_back(vulkan::describe(static_cast<std::uint32_t>(devices.size()), device));
  return devices[vulkan::choose_device(devices, wanted)];
}

// What is left to the host: frames in which nothing stands in any light, and samples that see nothing.
void finish_lit(const FramePasses &prepared, Measurement &measurement) {
  if (!prepared.lit) {
    measurement.lit.resize(measurement.coverage.size());
    std::ranges::transform(measurement.coverage, measurement.lit.begin(),
                           [](float coverage) { return coverage > 0.0f ? 1.0f : 0.0f; });
    all_reached(prepared.groups, measurement.sample_reached);
  }
  if (!measurement.sample_reached.empty())
    clear_unseen(measurement);
}

// The first, a later one and the last, which may be shorter.
std::set<std::size_t> windows_to_warm(std::size_t count) {
  return {0, std::min<std::size_t>(1, count - 1), count - 1};
}

LitWindow few_runs(LitWindow window) {
  window.last_run = std::min(window.last_run, window.first_run + 2);
  return window;
}

void nobody(double) {}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

struct Simulator::State {
  // What a frame is to be made of; made again where the first plan does not keep what was promised.
  struct Requested {
    const Scene *scene;
    Sensor sensor;
    std::vector<Illuminator> illuminators;
    Backscatter backscatter;
    Shadows shadows;
    Accuracy accuracy;
  };

  explicit State(const SimulatorOptions &wanted)
      : options(wanted), instance(wanted.validate), info(choose(instance, wanted.device)),
        device(instance, std::move(instance.devices()[info.index])), recorder(device), textures(device) {}

  void prepare();
  void warm_up();
  void warm_up_lists(const PlannedStrip &pixel);
  std::optional<std::string> breach_of(const Measurement &measurement) const;
  void refine(const std::string &breach);
  void forget_broken();
  Measurement measure(const Progress &progress);
  void measure_strip(const PlannedStrip &planned, const Progress &progress, Measurement &measurement);
  void see(const PlannedStrip &planned);
  void light(const PlannedStrip &planned, std::size_t window);
  void keep_reached(const PlannedStrip &planned, std::size_t window, std::vector<std::uint32_t> &reached);
  void sum(const PlannedStrip &planned, const LitWindow &window, const AccumulatePass &pass,
           const vulkan::Buffer *list, const Progress &progress);
  void sum_listed(const PlannedStrip &planned, const Progress &progress);
  void sum_list(const PlannedStrip &planned, const LitWindow &window, std::uint32_t list,
                const AccumulatePass &accumulate, const ResolvePass &resolve, const Progress &progress);
  void read_back(const PlannedStrip &planned);
  void store(const PlannedStrip &planned, Measurement &measurement);
  Measurement spare_memory();
  void check_strip(std::size_t strip, Measurement &measurement);

  SimulatorOptions options;
  vulkan::Instance instance;
  DeviceInfo info;
  vulkan::Device device;
  vulkan::PassRecorder recorder;
  TextureCache textures;
  std::optional<Requested> requested;
  std::uint32_t attempt = 0; // of frame_plans
  std::optional<FramePasses> prepared;
  std::mutex spare_mutex;
  std::vector<Measurement> spare; // frames that are done with
};

void Simulator::State::see(const PlannedStrip &planned) {
  const StripBuffers &buffers = prepared->buffers;
  const auto *search = std::get_if<SearchPass>(&prepared->points);
  prepared->visibility.record(recorder.commands(), planned, prepared->scene, drawn_tags(buffers));
  recorder.end_pass("visibility");
  if (search)
    search->record(recorder.commands(), planned, buffers, prepared->scene);
  if (const auto *points = std::get_if<PointsPass>(&prepared->points))
    points->record(recorder.commands(), planned.strip, buffers, prepared->scene);
  if (!std::holds_alternative<std::monostate>(prepared->points))
    recorder.end_pass("points");
}

// Which diodes of the window reach the strip's samples.
void Simulator::State::light(const PlannedStrip &planned, std::size_t window) {
  const LitPass &lit = *prepared->lit;
  if (window == 0)
    lit.record_tiles(recorder.commands(), planned.strip, prepared->buffers);
  lit.record(recorder.commands(), planned.strip, prepared->buffers, window);
  recorder.end_pass("lit");
}

void Simulator::State::keep_reached(const PlannedStrip &planned, std::size_t window,
                                    std::vector<std::uint32_t> &reached) {
  record_reached(recorder.commands(), planned.strip, prepared->buffers, prepared->windows[window]);
  recorder.finish();
  store_reached(planned.strip, prepared->buffers, prepared->windows[window], prepared->groups, reached);
  recorder.begin();
}

void Simulator::State::sum(const PlannedStrip &planned, const LitWindow &window, const AccumulatePass &pass,
                           const vulkan::Buffer *list, const Progress &progress) {
  const std::uint32_t runs = pass.runs();
  const auto per_submission = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
      interactions_per_submission / pass.interactions_per_run(planned.strip), 1, runs));
  for (std::uint32_t first = window.first_run; first < window.last_run; first += per_submission) {
    const std::uint32_t last = std::min(window.last_run, first + per_submission);
    pass.record(recorder.commands(), planned.strip, prepared->buffers, prepared->scene, window, first, last,
                list);
    recorder.end_pass("accumulate");
    if (last < runs) {
      recorder.finish();
      progress(static_cast<double>(last) / runs);
      recorder.begin();
    }
  }
}

void Simulator::State::sum_list(const PlannedStrip &planned, const LitWindow &window, std::uint32_t list,
                                const AccumulatePass &accumulate, const ResolvePass &resolve,
                                const Progress &progress) {
  const ListedPasses &listed = *prepared->listed;
  const vulkan::Buffer &pixels = listed.lists.of(list);
  if (listed.points) {
    listed.points->record(recorder.commands(), planned.strip, prepared->buffers, prepared->scene, &pixels);
    recorder.end_pass("points");
  }
  sum(planned, window, accumulate, &pixels, progress);
  resolve.record(recorder.commands(), planned.strip, prepared->buffers, prepared->scene, &pixels);
  recorder.end_pass("resolve");
}

// Pixels that go the short way, then those that cannot.
void Simulator::State::sum_listed(const PlannedStrip &planned, const Progress &progress) {
  const ListedPasses &listed = *prepared->listed;
  const std::uint32_t side = planned.strip.samples;
  listed.lists.record_clear(recorder.commands());
  listed.short_way.record(recorder.commands(), planned.strip, prepared->buffers, prepared->scene);
  listed.lists.record_count(recorder.commands(), side * side);
  if (listed.few_places) {
    listed.few_places->record(recorder.commands(), planned.strip, prepared->buffers, prepared->scene,
                              &listed.lists.of(shader::list_few));
    listed.lists.record_count(recorder.commands(), side * side);
  }
  recorder.end_pass("short_way");
  if (listed.has_lit)
    sum_list(planned, {0, listed.accumulate.runs(), 0}, shader::list_lit, listed.accumulate, listed.resolve,
             progress);
  if (prepared->has_rest)
    sum_list(planned, prepared->windows.front(), shader::list_rest, prepared->accumulate, prepared->resolve,
             progress);
}

void Simulator::State::read_back(const PlannedStrip &planned) {
  record_read_back(recorder.commands(), planned.strip, prepared->buffers, prepared->signal, prepared->truth);
  recorder.end_pass("read_back");
}

// lavapipe compiles a shader at its first dispatch: every pass runs once, over a single pixel, and each that
// has a first and a later form twice. What becomes of the pixel is of no interest.
void Simulator::State::warm_up() {
  PlannedStrip pixel = prepared->strips.front();
  pixel.strip.columns = pixel.strip.rows = 1;
  pixel.strip.padded_pixels = padded(1);
  recorder.begin();
  see(pixel);
  for (const std::size_t i : windows_to_warm(prepared->windows.size())) {
    if (prepared->lit)
      light(pixel, i);
    if (!prepared->listed)
      sum(pixel, few_runs(prepared->windows[i]), prepared->accumulate, nullptr, nobody);
  }
  if (prepared->listed)
    warm_up_lists(pixel);
  else
    prepared->resolve.record(recorder.commands(), pixel.strip, prepared->buffers, prepared->scene);
  read_back(pixel);
  recorder.finish();
}

// Whatever way the pixel goes, it is put into every list.
void Simulator::State::warm_up_lists(const PlannedStrip &pixel) {
  const ListedPasses &listed = *prepared->listed;
  const std::array<std::uint32_t, 1> first{0};
  const std::uint32_t samples = pixel.strip.samples * pixel.strip.samples;
  listed.lists.record_clear(recorder.commands());
  listed.short_way.record(recorder.commands(), pixel.strip, prepared->buffers, prepared->scene);
  listed.lists.record_count(recorder.commands(), samples);
  if (listed.few_places) {
    const vulkan::Buffer &few = listed.lists.of(shader::list_few);
    record_fill(recorder.commands(), few, first, samples);
    listed.few_places->record(recorder.commands(), pixel.strip, prepared->buffers, prepared->scene, &few);
  }
  for (const std::uint32_t list : {shader::list_lit, shader::list_rest})
    record_fill(recorder.commands(), listed.lists.of(list), first, samples);
  if (listed.has_lit)
    sum_list(pixel, few_runs({0, listed.accumulate.runs(), 0}), shader::list_lit, listed.accumulate,
             listed.resolve, nobody);
  if (prepared->has_rest)
    sum_list(pixel, few_runs(prepared->windows.front()), shader::list_rest, prepared->accumulate,
             prepared->resolve, nobody);
}

void Simulator::State::measure_strip(const PlannedStrip &planned, const Progress &progress,
                                     Measurement &measurement) {
  recorder.begin();
  see(planned);
  for (std::size_t i = 0; i < prepared->windows.size(); ++i) {
    if (prepared->lit)
      light(planned, i);
    if (prepared->lit && options.keep_reached)
      keep_reached(planned, i, measurement.sample_reached);
    if (!prepared->listed)
      sum(planned, prepared->windows[i], prepared->accumulate, nullptr, progress);
  }
  if (prepared->listed) {
    sum_listed(planned, progress);
  } else {
    prepared->resolve.record(recorder.commands(), planned.strip, prepared->buffers, prepared->scene);
    recorder.end_pass("resolve");
  }
  read_back(planned);
  recorder.finish();
  store(planned, measurement);
  progress(1.0);
}

void Simulator::State::store(const PlannedStrip &planned, Measurement &measurement) {
  const auto start = std::chrono::steady_clock::now();
  store_strip(planned.strip, prepared->buffers, prepared->sensor, prepared->signal, prepared->truth,
              measurement);
  recorder.add("read_back", milliseconds_since(start));
}

Measurement Simulator::State::spare_memory() {
  const std::scoped_lock lock(spare_mutex);
  if (spare.empty())
    return {};
  Measurement memory = std::move(spare.back());
  spare.pop_back();
  return memory;
}

void Simulator::State::forget_broken() {
  recorder.begin();
  recorder.commands().fillBuffer(prepared->buffers.broken.get(), 0, sizeof(shader::BrokenPromise), 0);
  recorder.finish();
}

// Evaluates the strip's chosen pixels exactly; the bits of the last window are there still.
void Simulator::State::check_strip(std::size_t strip, Measurement &measurement) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<PassTime> times = recorder.times();
  const ExactCheck &check = *prepared->check;
  const PlannedStrip &planned = prepared->strips[strip];
  recorder.begin();
  check.record_points(recorder.commands(), strip, planned, prepared->buffers, prepared->scene);
  const bool many = prepared->windows.size() > 1;
  const auto windows = prepared->lit ? prepared->windows : std::vector{all_runs(check.groups())};
  for (std::size_t i = 0; i < windows.size(); ++i) {
    if (many)
      light(planned, i);
    sum(planned, windows[i], check.sum(), &check.list(), nobody);
  }
  check.record_channels(recorder.commands(), planned, prepared->buffers, prepared->scene);
  record_read_back(recorder.commands(), planned.strip, prepared->buffers, prepared->signal, prepared->truth);
  recorder.finish();
  recorder.reset(times);
  check.compare(strip, planned, prepared->buffers, measurement, measurement.accuracy);
  measurement.accuracy.check_ms += milliseconds_since(start);
}

void Simulator::State::prepare() {
  const auto &[scene, sensor, illuminators, backscatter, shadows, accuracy] = *requested;
  const FrameRequest request{*scene, sensor, illuminators, backscatter, shadows, accuracy};
  const auto make = [&](SpareMemory &&memory) {
    prepared.reset(); // the rest of its memory first
    prepared.emplace(prepare_passes(device, options, request, attempt, textures, std::move(memory)));
  };
  try {
    make(prepared ? release_memory(std::move(*prepared)) : SpareMemory());
  } catch (const Error &error) {
    if (error.code() != ExitCode::out_of_memory)
      throw;
    make({}); // there may be room without what was to be used again
  }
  textures.drop_unused();
  warm_up();
}

// Why the frame does not keep what was promised, if so.
std::optional<std::string> Simulator::State::breach_of(const Measurement &measurement) const {
  if (prepared->accuracy.mode == Mode::exact)
    return std::nullopt;
  return promise_breach(broken_promise(prepared->buffers), measurement.accuracy, prepared->accuracy,
                        prepared->sensor.ambiguity_m());
}

// The next plan. Throws Error (accuracy) where there is none.
void Simulator::State::refine(const std::string &breach) {
  if (prepared->accuracy.mode != Mode::automatic || attempt + 1 == frame_plans)
    throw Error(ExitCode::accuracy, breach);
  ++attempt;
  prepare();
}

Measurement Simulator::State::measure(const Progress &progress) {
  const auto start = std::chrono::steady_clock::now();
  recorder.reset();
  Measurement measurement = make_measurement(prepared->sensor, prepared->signal, options, spare_memory());
  const double memory_ms = milliseconds_since(start); // of a first frame, to which the system gives it
  measurement.accuracy = prepared->report;
  if (prepared->shadows != Shadows::automatic)
    measurement.lit.clear();
  if (prepared->shadows == Shadows::automatic && options.keep_reached)
    measurement.sample_reached = none_reached(prepared->sensor, prepared->groups);
  if (prepared->signal.promised)
    forget_broken();
  for (std::size_t i = 0; i < prepared->strips.size(); ++i) {
    const auto of_strip = [&](double fraction) {
      if (progress)
        progress((static_cast<double>(i) + fraction) / static_cast<double>(prepared->strips.size()));
    };
    measure_strip(prepared->strips[i], of_strip, measurement);
    if (prepared->check)
      check_strip(i, measurement);
  }
  if (prepared->shadows == Shadows::automatic)
    finish_lit(*prepared, measurement);
  recorder.add("read_back", memory_ms);
  measurement.passes = recorder.times();
  measurement.frame_ms = milliseconds_since(start) - measurement.accuracy.check_ms;
  return measurement;
}

Simulator::Simulator(const SimulatorOptions &options) : state_(std::make_unique<State>(options)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator &&) noexcept = default;
Simulator &Simulator::operator=(Simulator &&) noexcept = default;

const DeviceInfo &Simulator::device() const { return state_->info; }

void Simulator::prepare(const Scene &scene, const Sensor &sensor,
                        const std::vector<Illuminator> &illuminators, Backscatter backscatter,
                        Shadows shadows, const Accuracy &accuracy) {
  if (illuminators.empty() ||
      std::ranges::any_of(illuminators, &std::vector<Diode>::empty, &Illuminator::diodes))
    throw std::logic_error("no illuminator, or one without diodes");
  if (state_->options.sum == DiodeSum::direct && sensor.waveform.kind == Waveform::Kind::sine &&
      (accuracy.mode != Mode::exact || sensor.adaptive_samples))
    throw std::logic_error("no error is promised of a sine that is summed diode by diode");
  state_->requested = State::Requested{&scene, sensor, illuminators, backscatter, shadows, accuracy};
  state_->attempt = 0;
  state_->prepare();
}

void Simulator::reuse(Measurement &&frame) {
  constexpr std::size_t frames = 2; // no more are measured and written side by side, as a rule
  const std::scoped_lock lock(state_->spare_mutex);
  if (state_->spare.size() < frames)
    state_->spare.push_back(std::move(frame));
}

Measurement Simulator::measure(const Progress &progress) {
  if (!state_->prepared)
    throw std::logic_error("measure() before prepare()");
  Measurement measurement = state_->measure(progress);
  while (const auto breach = state_->breach_of(measurement)) {
    state_->refine(*breach);
    reuse(std::move(measurement));
    measurement = state_->measure(progress);
  }
  return measurement;
}

} // namespace pmdsim
