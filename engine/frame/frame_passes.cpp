#include "engine/frame/frame_passes.h"

#include "engine/shadow/occluders.h"
#include "engine/signal/channel_layout.h"
#include "engine/view/projection.h"
#include "engine/vulkan/shader_module.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

// A strip is a row of a block's pixels at least, so a block is no wider than the largest strip.
Projection project_blocks(const vulkan::Device &device, const CameraScene &camera, const Sensor &sensor,
                          std::uint32_t largest_strip) {
  const std::uint32_t fragments = std::min(raster_block_fragments(device), largest_strip / sensor.samples);
  return project(camera, sensor.has_distortion() ? distorted_blocks(sensor, fragments)
                                                 : chip_blocks(sensor, fragments));
}

std::optional<float> one_backscatter(const CameraScene &camera,
                                     const std::vector<shader::TrianglePlane> &planes) {
  const auto of = [&](const CameraTriangle &triangle) { return planes[triangle.id].backscatter; };
  const auto &triangles = camera.triangles;
  if (triangles.empty() || !std::ranges::all_of(triangles, [&](const CameraTriangle &triangle) {
        return of(triangle) == of(triangles.front());
      }))
    return std::nullopt;
  return of(triangles.front());
}

SceneBuffers upload_scene(const vulkan::Device &device, const CameraScene &camera, const Scene &scene,
                          const Sensor &sensor, Backscatter backscatter, TextureCache &textures) {
  auto planes = triangle_planes(camera, scene, backscatter,
                                sensor.has_distortion() ? AlongRay::range : AlongRay::depth);
  if (planes.empty()) // what sees nothing looks the first one up
    planes.emplace_back();
  PaintBuffers paint = upload_paint(device, camera, scene, backscatter, textures);
  const auto one = paint.painted ? std::nullopt : one_backscatter(camera, planes);
  return {vulkan::upload(device, std::as_bytes(std::span(planes))), std::move(paint), one,
          camera.world_rounding_m};
}

// Of one sample a pixel.
TruthOfRecords truth_of_records(const vulkan::Device &device, const SimulatorOptions &options,
                                const Scene &scene) {
  TruthOfRecords truth{{}, vulkan::uses_fp64(device, options.precision)};
  truth.object_of_shape.reserve(scene.shape_count());
  for (std::uint32_t id = 0; id < scene.shape_count(); ++id)
    truth.object_of_shape.push_back(scene.object_of(id));
  return truth;
}

// The frame as the host sees it.
struct HostView {
  CameraScene camera;
  std::vector<CameraIlluminator> lights;
  Occluders occluders;
  Signal signal;
  SumModel model;
  Projection projection;
  std::uint32_t largest_strip;
};

HostView look(const vulkan::Device &device, const SimulatorOptions &options, const FrameRequest &request) {
  HostView view;
  const bool shaded = request.shadows == Shadows::automatic;
  view.camera = to_camera(request.scene, request.sensor);
  view.lights = to_camera(request.illuminators, request.sensor);
  const bool facing = all_face_the_light(view.camera, view.lights);
  if (shaded)
    view.occluders = find_occluders(view.camera, request.scene, view.lights);
  view.signal = signal_of(request.sensor, options);
  view.signal.lit = shaded && (!view.occluders.shapes.empty() || !facing);
  view.signal.promised = request.accuracy.mode != Mode::exact || request.sensor.adaptive_samples;
  view.model = sum_model(view.lights, request.backscatter, facing);
  // With shadows a quarter on GPUs: 7e7 rays of 256 diodes at a time, which none takes 100 ms for.
  view.largest_strip = samples_of_a_strip(view.signal.lit && !device.is_cpu() ? 1u << 18 : 1u << 20,
                                          view.signal.sum_planes(), ChannelLayout(view.signal).channels(),
                                          request.sensor.samples * request.sensor.samples);
  view.projection = project_blocks(device, view.camera, request.sensor, view.largest_strip);
  return view;
}

// Which ways a frame's pixels go.
struct Ways {
  bool rest;       // some may not face or be lit by all diodes
  bool short_way;  // in one pass, where that can be
  bool thin_out;   // one place may stand in for a pixel's samples
  bool listed;     // pixels differ in how they are summed
  bool all_points; // the point of every sample is made
  bool plain;      // all samples go one way, on which their records are all that is kept of them
};

Ways choose_ways(const FramePlan &plan, const HostView &view, const FrameRequest &request,
                 std::size_t windows, bool painted) {
  const Sensor &sensor = request.sensor;
  // The bits of several windows are never there together, so that nothing is known of a sample before it is
  // summed.
  const bool one_window = !view.signal.lit || windows == 1;
  Ways ways{};
  ways.rest = view.signal.lit || view.model.backscatter != shader::backscatter_flat;
  const bool can =
      plan.short_promise && one_window && ShortWay::can_sum(plan.short_groups, view.signal, sensor);
  // Within a pixel the light has to change as a known function does: paint may not, nor where beams end.
  const bool is_smooth =
      !painted && sensor.vignetting == Vignetting::none && std::isfinite(plan.extent.pattern_slope);
  ways.thin_out = can && sensor.samples > 1 && is_smooth &&
                  (sensor.adaptive_samples || request.accuracy.mode == Mode::automatic);
  ways.short_way = can && (sensor.samples == 1 || ways.thin_out);
  ways.listed = ways.short_way || (plan.is_reduced() && ways.rest && one_window);
  ways.plain = !ways.listed && !plan.is_reduced() && !view.signal.lit && !view.signal.promised &&
               view.signal.by_moments && plan.precision == Precision::fp32 && ChipGrid::holds(sensor);
  ways.all_points = !ways.plain && (!ways.listed || view.signal.lit || sensor.has_distortion());
  return ways;
}

std::variant<std::monostate, PointsPass, SearchPass>
all_points(const vulkan::Device &device, const SimulatorOptions &options, const FrameRequest &request,
           const HostView &view, const FramePlan &plan, const Ways &ways, const PaintBuffers &paint) {
  const std::uint32_t vectors = view.model.surface_vectors(plan.precision);
  if (request.sensor.has_distortion())
    return SearchPass(device, request.sensor, view.camera, request.scene, view.projection.blocks, vectors,
                      paint, options.precision);
  if (!ways.all_points)
    return std::monostate();
  return PointsPass(device, request.sensor, vectors, paint.painted, options.precision);
}

// In which precision the check sums: what is there already, points of distorted samples or bits in the order
// of the plan's diodes, is in the plan's.
Precision check_precision(const HostView &view, const FramePlan &plan, const Sensor &sensor) {
  return view.signal.lit || sensor.has_distortion() ? plan.precision
                                                    : sum_precision(view.signal, Precision::fp64);
}

ExactCheck make_check(const vulkan::Device &device, const SimulatorOptions &options,
                      const FrameRequest &request, const HostView &view, const FramePlan &plan,
                      Precision precision, const std::vector<PlannedStrip> &strips,
                      const SceneBuffers &scene) {
  Signal signal = view.signal;
  signal.promised = false;
  DiodeGroups groups =
      precision == plan.precision
          ? plan.all
          : group_diodes(view.lights, view.projection.visible, signal.largest_wavenumber_rad_m(), precision);
  return {device,     request.sensor,
          strips,     signal,
          view.model, std::move(groups),
          options,    {precision, !request.sensor.has_distortion(), scene.paint.painted}};
}

ListedPasses make_listed(const vulkan::Device &device, const SimulatorOptions &options,
                         const FrameRequest &request, const HostView &view, const FramePlan &plan,
                         const Ways &ways, const std::vector<PlannedStrip> &strips,
                         const SceneBuffers &scene) {
  // Of one sample a pixel, the short way takes all that every diode lights and that surely keep the promise.
  const bool has_lit = !ways.short_way || request.sensor.samples > 1 || !plan.surely_kept;
  const bool lists_pixels = has_lit || ways.rest;
  PixelLists lists(device, strips);
  const auto make_short_way = [&](const Promise &promise, const ShortWayOptions &of) {
    return ShortWay(device, request.sensor, plan.short_groups, plan.extent, view.model, view.signal, promise,
                    options, of, lists);
  };
  const bool few = ways.thin_out && plan.few_promise;
  ShortWay short_way =
      make_short_way(plan.short_promise ? *plan.short_promise : *plan.promise,
                     {scene.paint.painted, ways.thin_out ? 1u : 0u, few, ways.short_way, lists_pixels});
  std::optional<ShortWay> few_places;
  if (few)
    few_places.emplace(make_short_way(*plan.few_promise, {.painted = false, .places = 4}));
  std::optional<PointsPass> points;
  if (!ways.all_points)
    points.emplace(device, request.sensor, view.model.surface_vectors(plan.precision), scene.paint.painted,
                   options.precision, true);
  return {std::move(lists),
          std::move(short_way),
          std::move(few_places),
          std::move(points),
          has_lit,
          AccumulatePass(device, plan.stand_ins, view.model, view.signal, options,
                         {false, true, plan.precision, plan.promise}),
          ResolvePass(device, view.signal, plan.stand_ins, options,
                      {is_tiled(request.sensor), true, plan.precision, plan.promise})};
}

// What is kept of samples: on the plain way their records and returns, else more.
SampleLayout layout_of(const Signal &signal, bool host_reads_tags, bool plain, bool single_run,
                       std::uint32_t surface_vectors) {
  SampleLayout layout{.host_reads_tags = host_reads_tags,
                      .tag_bytes = plain ? sizeof(shader::uvec4) : sizeof(shader::uvec2),
                      .position_bytes = plain ? 0 : 3 * sizeof(double),
                      .backscatter_bytes = plain ? 0 : sizeof(float),
                      .surface_vectors = plain ? 0 : surface_vectors,
                      .sum_bytes = plain && single_run ? sizeof(shader::vec2) : sizeof(shader::vec4),
                      .sum_planes = signal.sum_planes(),
                      .channels = ChannelLayout(signal).channels(),
                      .visibility_words = signal.lit ? shader::bundles_per_window : 0,
                      .keeps_terms = signal.promised};
  return layout;
}

std::uint32_t shining(const DiodeGroups &groups) {
  return static_cast<std::uint32_t>(
      std::ranges::count_if(groups.places, [](const DiodePlace &place) { return place.number != no_id; }));
}

// What is known before the frame.
AccuracyReport report_of(const FramePlan &plan, const Ways &ways, bool stand_in) {
  AccuracyReport report;
  report.precision = plan.precision;
  report.diodes = shining(ways.listed || stand_in ? plan.stand_ins : plan.all);
  report.claimed_m = plan.claimed_m;
  report.claimed_amplitude = plan.claimed_amplitude;
  return report;
}

} // namespace

SpareMemory release_memory(FramePasses &&passes) {
  return {std::move(passes.buffers), passes.visibility.release_images()};
}

FramePasses prepare_passes(const vulkan::Device &device, const SimulatorOptions &options,
                           const FrameRequest &request, std::uint32_t attempt, TextureCache &textures,
                           SpareMemory &&spare) {
  const Sensor &sensor = request.sensor;
  HostView view = look(device, options, request);
  FramePlan plan = plan_frame({view.camera, view.lights, view.projection.visible, sensor, view.signal,
                               view.model, request.backscatter, device.is_cpu()},
                              request.accuracy, attempt);
  view.signal.promised = plan.promise.has_value();
  std::vector<LitWindow> windows = view.signal.lit ? plan_windows(plan.all) : std::vector{all_runs(plan.all)};
  SceneBuffers scene =
      upload_scene(device, view.camera, request.scene, sensor, request.backscatter, textures);
  const Ways ways = choose_ways(plan, view, request, windows.size(), scene.paint.painted);
  const bool checks = request.accuracy.mode != Mode::exact;
  const std::uint32_t samples =
      options.max_strip_samples > 0 ? options.max_strip_samples : view.largest_strip;
  const auto strips = plan_strips(sensor, view.projection.blocks, samples);
  const Precision of_check = checks ? check_precision(view, plan, sensor) : plan.precision;
  const bool single_run = plan.all.runs.size() == 1;
  std::optional<TruthOfRecords> truth;
  if (ways.plain && sensor.samples == 1)
    truth = truth_of_records(device, options, request.scene);
  const bool host_reads_tags = truth || options.keep_sample_tags || options.keep_reached;
  StripBuffers buffers = make_strip_buffers(
      device, strips, view.projection.blocks,
      layout_of(view.signal, host_reads_tags, ways.plain, single_run,
                std::max(view.model.surface_vectors(plan.precision), view.model.surface_vectors(of_check))),
      options, std::move(spare.buffers));
  std::optional<ChipGrid> grid;
  if (ways.plain)
    grid.emplace(device, sensor);
  VisibilityPass visibility(device, view.projection, sensor, strips, scene.paint.masked, options.precision,
                            grid, drawn_tags(buffers), std::move(spare.images));
  auto points = all_points(device, options, request, view, plan, ways, scene.paint);
  std::optional<LitPass> lit;
  if (view.signal.lit)
    lit.emplace(device, view.occluders, plan.all, windows, scene, strips, is_tiled(sensor),
                options.precision);
  std::optional<ListedPasses> listed;
  if (ways.listed)
    listed.emplace(make_listed(device, options, request, view, plan, ways, strips, scene));
  std::optional<ExactCheck> check;
  if (checks)
    check.emplace(make_check(device, options, request, view, plan, of_check, strips, scene));
  // Where all samples are alike, what stands in for the diodes does so for all of them.
  const bool stand_in = !ways.listed && !ways.rest && plan.is_reduced();
  const DiodeGroups &summed = stand_in ? plan.stand_ins : plan.all;
  const auto &promise = stand_in ? plan.promise : plan.promise_of_all;
  std::optional<ResolvePass::PlainScope> plain;
  if (grid)
    plain = ResolvePass::PlainScope{*grid,
                                    sensor.samples,
                                    single_run,
                                    sensor.vignetting == Vignetting::cos4,
                                    scene.paint.painted,
                                    scene.backscatter.has_value(),
                                    truth.has_value()};
  AccumulatePass accumulate(device, summed, view.model, view.signal, options,
                            {view.signal.lit, ways.listed, plan.precision, promise, grid});
  ResolvePass resolve(device, view.signal, summed, options,
                      {is_tiled(sensor), ways.listed, plan.precision, promise, plain});
  if (stand_in)
    windows = {all_runs(summed)};
  const AccuracyReport report = report_of(plan, ways, stand_in);
  return {sensor,
          view.signal,
          strips,
          std::move(scene),
          std::move(buffers),
          std::move(visibility),
          std::move(points),
          request.shadows,
          request.accuracy,
          std::move(plan.all),
          std::move(windows),
          std::move(lit),
          std::move(listed),
          ways.rest || !ways.listed,
          std::move(accumulate),
          std::move(resolve),
          std::move(truth),
          std::move(check),
          report};
}

} // namespace pmdsim
