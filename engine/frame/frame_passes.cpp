#include "engine/frame/frame_passes.h"

#include "engine/sampling/raster_blocks.h"
#include "engine/signal/channel_layout.h"
#include "engine/vulkan/shader_module.h"

#include <algorithm>
#include <array>
#include <span>

namespace pmdsim {
namespace {

// What all that is made for a frame follows from.
struct Basis {
  const vulkan::Device &device;
  const SimulatorOptions &options;
  const FrameRequest &request;
  const FrameFacts &facts;
  const FramePlan &plan;
  const FramePath &path;
};

std::vector<shader::TrianglePlane> planes_of(const FrameFacts &facts, const FrameRequest &request) {
  auto planes = triangle_planes(facts.camera, request.scene, request.backscatter,
                                request.sensor.has_distortion() ? AlongRay::range : AlongRay::depth);
  if (planes.empty()) // what sees nothing looks the first one up
    planes.emplace_back();
  return planes;
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

TruthOfRecords truth_of_records(const vulkan::Device &device, const SimulatorOptions &options,
                                const Scene &scene) {
  TruthOfRecords truth{{}, vulkan::uses_fp64(device, options.precision)};
  truth.object_of_shape.reserve(scene.shape_count());
  for (std::uint32_t id = 0; id < scene.shape_count(); ++id)
    truth.object_of_shape.push_back(scene.object_of(id));
  return truth;
}

// What a strip keeps of its samples.
SampleLayout layout_of(const Basis &on, bool host_reads_ids) {
  const bool depth_only = on.path.record == SampleRecord::depth;
  const Precision of_check = on.path.check.value_or(on.plan.precision);
  const std::uint32_t surface_vectors =
      std::max(on.facts.model.surface_vectors(on.plan.precision), on.facts.model.surface_vectors(of_check));
  const Signal &signal = on.facts.signal;
  return {.host_reads_tags = host_reads_ids,
          .tag_bytes = depth_only ? sizeof(shader::uvec4) : sizeof(shader::uvec2),
          .position_bytes = depth_only ? 0 : 3 * sizeof(double),
          .backscatter_bytes = depth_only ? 0 : sizeof(float),
          .surface_vectors = depth_only ? 0 : surface_vectors,
          .sum_bytes = depth_only && on.path.single_batch ? sizeof(shader::vec2) : sizeof(shader::vec4),
          .sum_planes = signal.sum_planes(),
          .channels = ChannelLayout(signal).channels(),
          .visibility_words = signal.lit ? shader::bundles_per_window : 0,
          .keeps_terms = signal.promised};
}

PointsPass points_pass(const Basis &on, Precision precision, bool listed) {
  return {on.device,       on.request.sensor,    on.facts.model.surface_vectors(precision),
          on.path.painted, on.options.precision, listed};
}

std::variant<std::monostate, PointsPass, SearchPass> every_point(const Basis &on, const PaintBuffers &paint) {
  if (on.path.grid == SampleGrid::distorted)
    return SearchPass(on.device, on.request.sensor, on.facts.camera, on.request.scene,
                      on.facts.projection.blocks, on.facts.model.surface_vectors(on.plan.precision), paint,
                      on.options.precision);
  if (!on.path.points_first)
    return std::monostate();
  return points_pass(on, on.plan.precision, false);
}

std::optional<ResolvePass::PlainScope> plain_scope(const Basis &on, const std::optional<ChipGrid> &grid) {
  if (!grid)
    return std::nullopt;
  return ResolvePass::PlainScope{
      *grid,           on.request.sensor.samples, on.path.single_batch,    on.path.vignetting,
      on.path.painted, on.path.one_backscatter,   on.path.host_reads_truth};
}

// Sources of a class's sum.
const DiodeGroups &sources_of(const PixelClass &pixels, const FramePlan &plan) {
  return pixels.reduced ? plan.stand_ins : plan.all;
}

std::optional<ClassPasses> class_passes(const Basis &on, PixelsOf who, const std::optional<ChipGrid> &grid) {
  const PixelClass *pixels = on.path.of(who);
  if (!pixels)
    return std::nullopt;
  const DiodeGroups &groups = sources_of(*pixels, on.plan);
  const bool listed = who != PixelsOf::all;
  return ClassPasses{AccumulatePass(on.device, groups, on.facts.model, on.facts.signal, on.options,
                                    {pixels->shadowed, listed, pixels->precision, pixels->bound, grid}),
                     ResolvePass(on.device, on.facts.signal, groups, on.options,
                                 {is_tiled(on.request.sensor), listed, pixels->precision, pixels->bound,
                                  plain_scope(on, grid)})};
}

// The pass that sorts, whether it sums or not.
ShortWay uniform_pass(const Basis &on, const PixelLists &lists) {
  const PixelClass *uniform = on.path.of(PixelsOf::uniform);
  const Promise &bound = on.plan.short_promise ? *on.plan.short_promise : *on.plan.promise;
  return {on.device,
          on.request.sensor,
          on.plan.short_groups,
          on.plan.extent,
          on.facts.model,
          on.facts.signal,
          bound,
          on.options,
          {.painted = on.path.painted,
           .places = uniform && on.request.sensor.samples > 1 ? uniform->points : 0,
           .few_follow = on.path.of(PixelsOf::uniform_refined) != nullptr,
           .sums = uniform != nullptr,
           .lists = on.path.lists_pixels()},
          lists};
}

std::optional<ShortWay> refined_pass(const Basis &on, const PixelLists &lists) {
  const PixelClass *refined = on.path.of(PixelsOf::uniform_refined);
  if (!refined)
    return std::nullopt;
  return ShortWay(on.device, on.request.sensor, on.plan.short_groups, on.plan.extent, on.facts.model,
                  on.facts.signal, *refined->bound, on.options, {.painted = false, .places = refined->points},
                  lists);
}

SortedPasses sorted_passes(const Basis &on, const std::vector<PlannedStrip> &strips) {
  PixelLists lists(on.device, strips);
  ShortWay uniform = uniform_pass(on, lists);
  std::optional<ShortWay> refined = refined_pass(on, lists);
  std::optional<PointsPass> points;
  if (!on.path.points_first)
    points = points_pass(on, on.plan.precision, true);
  return {std::move(lists), std::move(uniform), std::move(refined), std::move(points)};
}

ExactCheck spot_check(const Basis &on, const std::vector<PlannedStrip> &strips) {
  Signal signal = on.facts.signal;
  signal.promised = false;
  const Precision precision = *on.path.check;
  DiodeGroups groups = precision == on.plan.precision
                           ? on.plan.all
                           : group_diodes(on.facts.lights, on.facts.projection.visible,
                                          signal.largest_wavenumber_rad_m(), precision);
  return {on.device,      on.request.sensor,
          strips,         signal,
          on.facts.model, std::move(groups),
          on.options,     {precision, on.path.check_makes_points, on.path.painted}};
}

std::uint32_t shining(const DiodeGroups &groups) {
  return static_cast<std::uint32_t>(
      std::ranges::count_if(groups.places, [](const DiodePlace &place) { return place.number != no_id; }));
}

// What is known before the frame.
AccuracyReport report_of(const FramePlan &plan, const FramePath &path) {
  AccuracyReport report;
  report.precision = plan.precision;
  report.diodes = shining(path.classes.front().reduced ? plan.stand_ins : plan.all);
  report.claimed_m = plan.claimed_m;
  report.claimed_amplitude = plan.claimed_amplitude;
  return report;
}

FramePasses make_passes(const Basis &on, std::vector<LitWindow> windows, SceneBuffers scene,
                        SpareMemory &&spare) {
  const auto &[device, options, request, facts, plan, path] = on;
  const auto strips =
      plan_strips(request.sensor, facts.projection.blocks,
                  options.max_strip_samples > 0 ? options.max_strip_samples : facts.largest_strip);
  std::optional<TruthOfRecords> truth;
  if (path.host_reads_truth)
    truth = truth_of_records(device, options, request.scene);
  std::optional<ChipGrid> grid;
  if (path.record == SampleRecord::depth)
    grid.emplace(device, request.sensor);
  StripBuffers buffers =
      make_strip_buffers(device, strips, facts.projection.blocks,
                         layout_of(on, truth || options.keep_sample_tags || options.keep_reached), options,
                         std::move(spare.buffers));
  VisibilityPass raster(device, facts.projection, request.sensor, strips, scene.paint.masked,
                        options.precision, grid, drawn_tags(buffers), std::move(spare.images));
  auto points = every_point(on, scene.paint);
  std::optional<LitPass> shadow;
  if (path.windows > 0)
    shadow.emplace(device, facts.occluders, plan.all, windows, scene, strips, is_tiled(request.sensor),
                   options.precision);
  std::optional<SortedPasses> sorted;
  if (path.is_sorted())
    sorted.emplace(sorted_passes(on, strips));
  std::optional<ExactCheck> check;
  if (path.check)
    check.emplace(spot_check(on, strips));
  if (path.classes.front().reduced && !path.is_sorted())
    windows = {all_runs(plan.stand_ins)};
  return {path,
          request.sensor,
          facts.signal,
          strips,
          std::move(scene),
          std::move(buffers),
          std::move(raster),
          std::move(points),
          plan.all,
          std::move(windows),
          std::move(shadow),
          std::move(sorted),
          class_passes(on, PixelsOf::all, grid),
          class_passes(on, PixelsOf::unshadowed, {}),
          class_passes(on, PixelsOf::rest, {}),
          std::move(truth),
          std::move(check),
          report_of(plan, path)};
}

} // namespace

FramePasses make_passes(const vulkan::Device &device, const SimulatorOptions &options,
                        const FrameRequest &request, std::uint32_t attempt, TextureCache &textures,
                        SpareMemory &&spare) {
  FrameFacts facts = look(device, options, request);
  const FramePlan plan = plan_frame({facts.lights, facts.projection.visible, request.sensor, facts.signal,
                                     facts.model, request.backscatter, device.is_cpu(), options.allowed},
                                    request.accuracy, attempt);
  facts.signal.promised = plan.promise.has_value();
  std::vector<LitWindow> windows =
      facts.signal.lit ? plan_windows(plan.all) : std::vector{all_runs(plan.all)};
  const auto planes = planes_of(facts, request);
  const auto backscatter = one_backscatter(facts.camera, planes);
  const FramePath path = choose_path(facts, plan, request, windows.size(), backscatter, options.allowed);
  SceneBuffers scene{
      vulkan::upload(device, std::as_bytes(std::span(planes))),
      upload_paint(device, facts.paint, facts.camera, request.scene, request.backscatter, textures),
      path.one_backscatter ? backscatter : std::nullopt, facts.camera.world_rounding_m};
  return make_passes({device, options, request, facts, plan, path}, std::move(windows), std::move(scene),
                     std::move(spare));
}

} // namespace pmdsim
