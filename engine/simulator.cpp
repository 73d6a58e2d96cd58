#include "engine/simulator.h"

#include "engine/error.h"
#include "engine/passes/accumulate.h"
#include "engine/passes/camera_scene.h"
#include "engine/passes/diode_groups.h"
#include "engine/passes/lit.h"
#include "engine/passes/occluders.h"
#include "engine/passes/points.h"
#include "engine/passes/projection.h"
#include "engine/passes/reached.h"
#include "engine/passes/read_back.h"
#include "engine/passes/resolve.h"
#include "engine/passes/search.h"
#include "engine/passes/strip_buffers.h"
#include "engine/passes/strips.h"
#include "engine/passes/visibility.h"
#include "engine/vulkan/device_choice.h"
#include "engine/vulkan/pass_recorder.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <ranges>
#include <set>
#include <stdexcept>
#include <variant>

namespace pmdsim {
namespace {

// One submission's work at most, so that a frame can be stopped and shows its progress.
constexpr std::uint64_t interactions_per_submission = 2'000'000'000;

DeviceInfo choose(const vulkan::Instance &instance, const std::string &wanted) {
  std::vector<DeviceInfo> devices;
  for (const auto &device : instance.devices())
    devices.push_back(vulkan::describe(static_cast<std::uint32_t>(devices.size()), device));
  return devices[vulkan::choose_device(devices, wanted)];
}

// What one sensor, its light and scene need on the device.
struct Prepared {
  Sensor sensor;
  Signal signal;
  std::vector<PlannedStrip> strips;
  SceneBuffers scene;
  StripBuffers buffers;
  VisibilityPass visibility;
  std::variant<PointsPass, SearchPass> points; // without and with distortion
  Shadows shadows;
  DiodeGroups groups;
  std::vector<LitWindow> windows;
  std::optional<LitPass> lit; // nothing where every diode reaches whatever is seen
  AccumulatePass accumulate;
  ResolvePass resolve;
};

std::variant<PointsPass, SearchPass> points_pass(const vulkan::Device &device, const Sensor &sensor,
                                                 const CameraScene &camera, const Scene &scene,
                                                 const std::vector<RasterBlock> &blocks,
                                                 std::uint32_t surface_vectors, const PaintBuffers &paint,
                                                 SamplePrecision precision) {
  if (sensor.has_distortion())
    return SearchPass(device, sensor, camera, scene, blocks, surface_vectors, paint, precision);
  return PointsPass(device, sensor, surface_vectors, paint.painted, precision);
}

// A strip is a row of a block's pixels at least, so a block is no wider than the largest strip.
Projection project_blocks(const vulkan::Device &device, const CameraScene &camera, const Sensor &sensor,
                          std::uint32_t largest_strip) {
  const std::uint32_t fragments = std::min(raster_block_fragments(device), largest_strip / sensor.samples);
  return project(camera, sensor.has_distortion() ? distorted_blocks(sensor, fragments)
                                                 : chip_blocks(sensor, fragments));
}

SceneBuffers upload_scene(const vulkan::Device &device, const CameraScene &camera, const Scene &scene,
                          const Sensor &sensor, Backscatter backscatter, TextureCache &textures) {
  const auto planes = triangle_planes(camera, scene, backscatter,
                                      sensor.has_distortion() ? AlongRay::range : AlongRay::depth);
  return {vulkan::upload(device, std::as_bytes(std::span(planes))),
          upload_paint(device, camera, scene, backscatter, textures), camera.world_rounding_m};
}

Prepared prepare_passes(const vulkan::Device &device, const SimulatorOptions &options, const Scene &scene,
                        const Sensor &sensor, const std::vector<Illuminator> &illuminators,
                        Backscatter backscatter, Shadows shadows, Precision wanted, TextureCache &textures) {
  const CameraScene camera = to_camera(scene, sensor);
  const std::vector<CameraIlluminator> lights = to_camera(illuminators, sensor);
  const bool facing = all_face_the_light(camera, lights);
  const Occluders occluders =
      shadows == Shadows::automatic ? find_occluders(camera, scene, lights) : Occluders();
  Signal signal = signal_of(sensor, options);
  signal.lit = shadows == Shadows::automatic && (!occluders.shapes.empty() || !facing);
  const std::uint32_t largest_strip = samples_of_a_strip(signal, sensor.samples * sensor.samples);
  const std::uint32_t strip_samples =
      options.max_strip_samples > 0 ? options.max_strip_samples : largest_strip;
  const Projection projection = project_blocks(device, camera, sensor, largest_strip);
  const Precision precision = sum_precision(signal, wanted);
  DiodeGroups groups = group_diodes(lights, projection.visible, signal.largest_wavenumber_rad_m(), precision);
  const SumModel model = sum_model(lights, backscatter, facing);
  const auto strips = plan_strips(sensor, projection.blocks, strip_samples);
  SceneBuffers buffers = upload_scene(device, camera, scene, sensor, backscatter, textures);
  VisibilityPass visibility(device, projection, sensor, strips, buffers.paint.masked, options.precision);
  auto points = points_pass(device, sensor, camera, scene, projection.blocks,
                            model.surface_vectors(precision), buffers.paint, options.precision);
  std::vector<LitWindow> windows = signal.lit ? plan_windows(groups) : std::vector{all_runs(groups)};
  std::optional<LitPass> lit;
  if (signal.lit)
    lit.emplace(device, occluders, groups, windows, buffers, strips, is_tiled(sensor), options.precision);
  AccumulatePass accumulate(device, groups, model, signal, options, {signal.lit, false, precision});
  ResolvePass resolve(device, signal, groups, options, {is_tiled(sensor), false, precision, {}});
  return {sensor,
          signal,
          strips,
          std::move(buffers),
          make_strip_buffers(device, strips, projection.blocks, signal, model.surface_vectors(precision),
                             options),
          std::move(visibility),
          std::move(points),
          shadows,
          std::move(groups),
          std::move(windows),
          std::move(lit),
          std::move(accumulate),
          std::move(resolve)};
}

// What is left to the host: frames in which nothing stands in any light, and samples that see nothing.
void finish_lit(const Prepared &prepared, Measurement &measurement) {
  if (!prepared.lit) {
    const auto lit = std::views::transform(measurement.coverage,
                                           [](float coverage) { return coverage > 0.0f ? 1.0f : 0.0f; });
    measurement.lit.assign(lit.begin(), lit.end());
    all_reached(prepared.groups, measurement.sample_reached);
  }
  if (!measurement.sample_reached.empty())
    clear_unseen(measurement);
}

// The first, a later one and the last, which may be shorter.
std::set<std::size_t> windows_to_warm(std::size_t count) {
  return {0, std::min<std::size_t>(1, count - 1), count - 1};
}

} // namespace

struct Simulator::State {
  explicit State(const SimulatorOptions &wanted)
      : options(wanted), instance(wanted.validate), info(choose(instance, wanted.device)),
        device(instance, std::move(instance.devices()[info.index])), recorder(device), textures(device) {}

  void warm_up();
  void measure_strip(const PlannedStrip &planned, const Progress &progress, Measurement &measurement);
  void see(const PlannedStrip &planned);
  void light(const PlannedStrip &planned, std::size_t window);
  void keep_reached(const PlannedStrip &planned, std::size_t window, std::vector<std::uint32_t> &reached);
  void sum(const PlannedStrip &planned, const LitWindow &window, const Progress &progress);
  void resolve(const PlannedStrip &planned);

  SimulatorOptions options;
  vulkan::Instance instance;
  DeviceInfo info;
  vulkan::Device device;
  vulkan::PassRecorder recorder;
  TextureCache textures;
  std::optional<Prepared> prepared;
};

void Simulator::State::see(const PlannedStrip &planned) {
  const StripBuffers &buffers = prepared->buffers;
  const auto *points = std::get_if<PointsPass>(&prepared->points);
  prepared->visibility.record(recorder.commands(), planned, prepared->scene,
                              points ? buffers.tags : buffers.fragments);
  recorder.end_pass("visibility");
  if (points)
    points->record(recorder.commands(), planned.strip, buffers, prepared->scene);
  else
    std::get<SearchPass>(prepared->points).record(recorder.commands(), planned, buffers, prepared->scene);
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

void Simulator::State::sum(const PlannedStrip &planned, const LitWindow &window, const Progress &progress) {
  const std::uint32_t runs = prepared->accumulate.runs();
  const auto per_submission = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
      interactions_per_submission / prepared->accumulate.interactions_per_run(planned.strip), 1, runs));
  for (std::uint32_t first = window.first_run; first < window.last_run; first += per_submission) {
    const std::uint32_t last = std::min(window.last_run, first + per_submission);
    prepared->accumulate.record(recorder.commands(), planned.strip, prepared->buffers, window, first, last);
    recorder.end_pass("accumulate");
    if (last < runs) {
      recorder.finish();
      progress(static_cast<double>(last) / runs);
      recorder.begin();
    }
  }
}

void Simulator::State::resolve(const PlannedStrip &planned) {
  prepared->resolve.record(recorder.commands(), planned.strip, prepared->buffers, prepared->scene.planes);
  recorder.end_pass("resolve");
  record_read_back(recorder.commands(), planned.strip, prepared->buffers, prepared->signal);
  recorder.end_pass("read_back");
}

// lavapipe compiles a shader at its first dispatch: every pass runs once, over a single pixel, and each that
// has a first and a later form twice.
void Simulator::State::warm_up() {
  PlannedStrip pixel = prepared->strips.front();
  pixel.strip.columns = pixel.strip.rows = 1;
  pixel.strip.padded_pixels = padded(1);
  recorder.begin();
  see(pixel);
  for (const std::size_t i : windows_to_warm(prepared->windows.size())) {
    LitWindow window = prepared->windows[i];
    window.last_run = std::min(window.last_run, window.first_run + 2);
    if (prepared->lit)
      light(pixel, i);
    sum(pixel, window, [](double) {});
  }
  resolve(pixel);
  recorder.finish();
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
    sum(planned, prepared->windows[i], progress);
  }
  resolve(planned);
  recorder.finish();
  store_strip(planned.strip, prepared->buffers, prepared->sensor, prepared->signal, measurement);
  progress(1.0);
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
  state_->prepared.reset(); // its memory first
  state_->prepared.emplace(prepare_passes(state_->device, state_->options, scene, sensor, illuminators,
                                          backscatter, shadows, accuracy.precision.value_or(Precision::fp32),
                                          state_->textures));
  state_->textures.drop_unused();
  state_->warm_up();
}

Measurement Simulator::measure(const Progress &progress) {
  if (!state_->prepared)
    throw std::logic_error("measure() before prepare()");
  const auto start = std::chrono::steady_clock::now();
  state_->recorder.reset();
  Measurement measurement =
      make_measurement(state_->prepared->sensor, state_->prepared->signal, state_->options);
  if (state_->prepared->shadows == Shadows::automatic && state_->options.keep_reached)
    measurement.sample_reached = none_reached(state_->prepared->sensor, state_->prepared->groups);
  const auto &strips = state_->prepared->strips;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const auto of_strip = [&](double fraction) {
      if (progress)
        progress((static_cast<double>(i) + fraction) / static_cast<double>(strips.size()));
    };
    state_->measure_strip(strips[i], of_strip, measurement);
  }
  if (state_->prepared->shadows == Shadows::automatic)
    finish_lit(*state_->prepared, measurement);
  measurement.passes = state_->recorder.times();
  measurement.frame_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return measurement;
}

} // namespace pmdsim
