#include "engine/simulator.h"

#include "engine/frame/frame.h"
#include "engine/model/error.h"
#include "engine/multipath/multipath.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/errors.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace pmdsim {

namespace {

// Whether more than half of all returns may be off by more than was asked for: such a frame is of no use.
bool is_mostly_beyond(const Measurement &measured) {
  std::size_t returns = 0;
  for (const Return &of_frequency : measured.returns)
    returns += static_cast<std::size_t>(
        std::ranges::count_if(of_frequency.amplitude, [](float amplitude) { return amplitude > 0.0f; }));
  return 2 * measured.accuracy.unpromised > returns;
}

} // namespace

// The device, and what lives on it from frame to frame.
struct DeviceInUse {
  explicit DeviceInUse(const SimulatorOptions &asked)
      : instance(asked.validation), info(choose_device(instance, asked.device)),
        device(instance, std::move(instance.devices()[info.index])), recorder(device), textures(device) {}

  vulkan::Instance instance;
  DeviceInfo info;
  vulkan::Device device;
  vulkan::PassRecorder recorder;
  TextureCache textures;
};

namespace {

// A device that fails before it was ever of use was not lost.
std::unique_ptr<DeviceInUse> started(const SimulatorOptions &asked) {
  try {
    return vulkan::checked([&] { return std::make_unique<DeviceInUse>(asked); });
  } catch (const Error &error) {
    if (error.code() != ExitCode::device_lost)
      throw;
    throw Error(ExitCode::no_device, fmt::format("the Vulkan device does not start: {}", error.what()));
  }
}

} // namespace

struct Simulator::State {
  explicit State(const SimulatorOptions &asked)
      : wanted(asked), options(asked), in_use(started(asked)), info(in_use->info) {}

  // Whatever Vulkan throws there becomes an Error.
  template <class Use>
  auto with_device(const Use &use);
  void set_up_again();
  void prepare();
  bool is_kept(const Measurement &measured);
  bool refine();
  Measurement spare_memory();

  SimulatorOptions wanted;
  SimulatorOptions options; // what a frame takes: more than was wanted where it turned out to need that
  std::unique_ptr<DeviceInUse> in_use; // null where the one that was lost did not come back
  DeviceInfo info;
  bool is_lost = false;
  std::optional<FrameRequest> requested;
  std::uint32_t attempt = 0; // of frame_plans; made again where one does not keep the error asked for
  std::optional<Frame> frame;
  Multipath multipath;
  bool bounces = false; // whether it is asked for
  std::mutex spare_mutex;
  std::vector<Measurement> spare; // frames that are done with
};

Measurement Simulator::State::spare_memory() {
  const std::scoped_lock lock(spare_mutex);
  if (spare.empty())
    return {};
  Measurement memory = std::move(spare.back());
  spare.pop_back();
  return memory;
}

template <class Use>
auto Simulator::State::with_device(const Use &use) {
  try {
    return vulkan::checked(use);
  } catch (const Error &error) {
    is_lost = is_lost || error.code() == ExitCode::device_lost;
    throw;
  }
}

void Simulator::State::set_up_again() {
  frame.reset();
  in_use.reset(); // first, as a driver may give a device to one user alone
  std::unique_ptr<DeviceInUse> again;
  try {
    again = started(wanted);
  } catch (const Error &error) {
    throw Error(ExitCode::device_lost,
                fmt::format("the device was lost and does not come back: {}", error.what()));
  }
  if (again->info.name != info.name || again->info.driver != info.driver) // whose bits would be others
    throw Error(
        ExitCode::device_lost,
        fmt::format("the device was lost and does not come back: {} answers for it", again->info.name));
  in_use = std::move(again);
  is_lost = false;
}

void Simulator::State::prepare() {
  const auto make = [&](SpareMemory &&memory) {
    frame.reset(); // the rest of its memory first
    frame.emplace(in_use->device, options, *requested, attempt, in_use->textures, std::move(memory));
  };
  try {
    make(frame ? frame->release_memory() : SpareMemory());
  } catch (const Error &error) {
    if (error.code() != ExitCode::out_of_memory)
      throw;
    make({}); // there may be room without what was to be used again
  }
  in_use->textures.drop_unused();
  frame->warm_up(in_use->recorder);
}

// The next plan; false where there is none.
bool Simulator::State::refine() {
  if (requested->accuracy.mode != Mode::automatic || attempt + 1 == frame_plans)
    return false;
  ++attempt;
  prepare();
  return true;
}

// Whether a frame may be returned; else the next one is prepared. Throws Error (accuracy) where there is
// none.
bool Simulator::State::is_kept(const Measurement &measured) {
  if (const auto beyond_bound = frame->beyond_bound()) {
    if (!frame->is_most_exact() && refine())
      return false;
    if (requested->accuracy.strict || is_mostly_beyond(measured))
      throw Error(ExitCode::accuracy, *beyond_bound);
    if (!options.keep_error_bound) { // its pixels have to tell which of them may be off, and by how much
      options.keep_error_bound = true;
      prepare();
      return false;
    }
  }
  const auto beyond_check = frame->beyond_check(measured);
  if (!beyond_check)
    return true;
  if (!refine())
    throw Error(ExitCode::accuracy, *beyond_check);
  return false;
}

BouncesForecast forecast_bounces(const Scene &scene, const Sensor &sensor, const Bounces &bounces) {
  return Multipath::forecast(scene, sensor, bounces);
}

Simulator::Simulator(const SimulatorOptions &options) : state_(std::make_unique<State>(options)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator &&) noexcept = default;
Simulator &Simulator::operator=(Simulator &&) noexcept = default;

const DeviceInfo &Simulator::device() const { return state_->info; }

const SimulatorOptions &Simulator::options() const { return state_->wanted; }

void Simulator::change(const SimulatorOptions &options) { state_->wanted = options; }

void Simulator::give_up_device() { state_->is_lost = true; }

void Simulator::prepare(const Scene &scene, const Sensor &sensor,
                        const std::vector<Illuminator> &illuminators, Backscatter backscatter,
                        Shadows shadows, const Accuracy &accuracy, const Bounces &bounces) {
  if (illuminators.empty() ||
      std::ranges::any_of(illuminators, &std::vector<Diode>::empty, &Illuminator::diodes))
    throw std::logic_error("no illuminator, or one without diodes");
  if (bounces.any() && backscatter != Backscatter::lambert)
    throw std::logic_error("bounces off surfaces that are not Lambert's");
  state_->requested.emplace(FrameRequest{scene, sensor, illuminators, backscatter, shadows, accuracy});
  state_->attempt = 0;
  state_->options = state_->wanted;
  state_->bounces = bounces.any();
  // Electrons are counted from the samples of any waveform but a sine.
  state_->options.keep_taps =
      state_->wanted.keep_taps || (sensor.electronics && sensor.waveform.kind != Waveform::Kind::sine);
  state_->options.count_electrons = state_->wanted.count_electrons && !bounces.any();
  state_->options.keep_sample_ids = state_->wanted.keep_sample_ids || (bounces.any() && sensor.samples > 1);
  if (bounces.any())
    state_->multipath.prepare({scene, sensor, illuminators, shadows, bounces});
  if (state_->is_lost)
    state_->set_up_again();
  state_->with_device([&] { state_->prepare(); });
}

std::vector<std::pair<std::string, std::string>> Simulator::path() const {
  if (!state_->frame)
    throw std::logic_error("path() before prepare()");
  return description(state_->frame->path());
}

void Simulator::reuse(Measurement &&frame) {
  constexpr std::size_t frames = 2; // no more are measured and written side by side, as a rule
  const std::scoped_lock lock(state_->spare_mutex);
  if (state_->spare.size() < frames)
    state_->spare.push_back(std::move(frame));
}

Measurement Simulator::measure(const Progress &progress, const ExposureNumber &number) {
  if (!state_->frame)
    throw std::logic_error("measure() before prepare()");
  constexpr double of_frame = 0.1; // of the time, where light bounces
  const auto direct_progress = [&](double fraction) { progress(of_frame * fraction); };
  const auto bounces_progress = [&](double fraction) { progress(of_frame + (1.0 - of_frame) * fraction); };
  const Progress none = [](double) {};
  const auto measure_once = [&] {
    return state_->frame->measure(state_->in_use->recorder, state_->spare_memory(),
                                  progress && state_->bounces ? direct_progress : progress, number);
  };
  Measurement measured = state_->with_device([&] {
    Measurement attempt = measure_once();
    while (!state_->is_kept(attempt)) {
      reuse(std::move(attempt));
      attempt = measure_once();
    }
    return attempt;
  });
  measured.bounces.reset();
  if (state_->bounces)
    state_->multipath.add_to(measured, progress ? bounces_progress : none);
  return measured;
}

} // namespace pmdsim
