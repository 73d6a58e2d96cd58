#include "engine/frame/frame_passes.h"

#include "engine/error_budget/planned_bounds.h"
#include "engine/frame/electrons_pass.h"
#include "engine/frame/shadow_passes.h"
#include "engine/frame/uniform_pixels_pass.h"
#include "engine/light/host/host_sum.h"
#include "engine/sampling/raster_blocks.h"
#include "engine/signal/channel_layout.h"
#include "engine/signal/claims_pass.h"
#include "engine/signal/demodulation_pass.h"
#include "engine/signal/direct_pixels.h"
#include "engine/signal/host/host_pixels.h"
#include "engine/signal/read_back.h"
#include "engine/view/edge_settling.h"
#include "engine/view/host/host_raster.h"
#include "engine/view/lens_search_pass.h"
#include "engine/view/points_pass.h"

#include <algorithm>

namespace pmdsim {
namespace {

std::vector<shader::TrianglePlane> planes_of(const FrameFacts &facts, const FrameRequest &request) {
  auto planes = triangle_planes(facts.camera, request.scene, request.backscatter,
                                request.sensor.has_distortion() ? AlongRay::range : AlongRay::depth);
  if (planes.empty()) // samples that see nothing look the first one up
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

// Of each sample.
std::uint32_t visibility_words(const FrameFacts &facts, const std::vector<SourceWindow> &windows) {
  std::uint32_t most = 0;
  for (const SourceWindow &window : windows)
    most = std::max(most, window.bundles);
  return facts.modulation.lit ? most : 0;
}

// The layout of what a strip keeps of its samples.
SampleLayout layout_of(const SimulatorOptions &options, const FrameFacts &facts, const FramePlan &plan,
                       const FramePath &path, std::uint32_t visibility_words) {
  const bool depth_only = path.keeps_depths_only();
  const Precision of_check =
      path.of(PixelsOf::precise) ? Precision::fp64 : path.check.value_or(plan.precision);
  const std::uint32_t surface_vectors =
      std::max(facts.model.surface_vectors(plan.precision), facts.model.surface_vectors(of_check));
  const Modulation &modulation = facts.modulation;
  return {.host_reads_ids = path.host_reads_truth || options.keep_sample_ids || options.keep_visibility,
          .id_bytes = path.record == SampleRecord::depth ? sizeof(shader::uvec4) : sizeof(shader::uvec2),
          .position_bytes = depth_only ? 0 : 3 * sizeof(double),
          .backscatter_bytes = depth_only ? 0 : sizeof(float),
          .surface_vectors = depth_only ? 0 : surface_vectors,
          .run_moments = path.host_sum != HostSum::none && !path.host_pixels
                             ? (path.moments + 1) * plan.all.runs.size()
                             : 0,
          .sum_bytes = depth_only && path.single_run ? sizeof(shader::vec2) : sizeof(shader::vec4),
          .sum_planes = modulation.sum_planes() +
                        (path.sums_records && modulation.keeps_terms ? (modulation.keeps_beams ? 2 : 1) : 0),
          .channels = ChannelLayout(modulation).channels(),
          .visibility_words = visibility_words,
          .held_errors = modulation.keeps_terms ? modulation.frequencies() : 0,
          .terms = !modulation.keeps_terms || path.keeps_depths_only() ? 0u
                   : modulation.keeps_beams                            ? 3u
                                                                       : 2u};
}

// The points of all samples, or those of `list`, for a sum of that precision.
Pass points_of(const FrameBasis &on, Precision precision, const vulkan::Buffer *list = nullptr) {
  return points_pass(on.device, on.options.precision, on.sensor, on.model.surface_vectors(precision),
                     on.buffers, on.scene, list);
}

Pass host_raster_pass(const FrameBasis &on, const std::optional<ChipGrid> &grid) {
  const auto raster =
      std::make_shared<const HostRaster>(on.facts.projection, on.sensor, on.facts.camera, on.request.scene,
                                         on.scene, grid, on.buffers.ids, on.options.host_vector_bits);
  return {.name = "visibility",
          .reads = no_resource,
          .writes = ids,
          .record = [](const Recording &) {},
          .prepare_warm_up =
              [&buffers = on.buffers](const Recording &at) {
                const auto records =
                    buffers.ids.mapped().first(sample_count(at.of_strip()) * buffers.id_bytes);
                std::ranges::fill(records, std::byte{0});
              },
          .store = [=](const Recording &at, Measurement &) { raster->draw(at.planned); }};
}

Pass raster_pass(const FrameBasis &on, const std::shared_ptr<const IdRasterPass> &raster,
                 const std::optional<ChipGrid> &grid) {
  std::shared_ptr<const EdgeSettling> edges;
  if (on.path.grid != SampleGrid::distorted)
    edges = std::make_shared<const EdgeSettling>(on.device, on.options.precision, on.sensor, on.facts.camera,
                                                 on.request.scene, on.facts.projection.blocks, grid);
  return {.name = "visibility",
          .reads = no_resource,
          .writes = ids,
          .record = [=, &scene = on.scene, &buffers = on.buffers](const Recording &at) {
            raster->record(at.commands, at.planned);
            if (edges)
              edges->record(at.commands, at.planned, scene.planes, buffers.ids);
          }};
}

// The passes that find what each sample sees, and where.
void list_view(const FrameBasis &on, const std::shared_ptr<const IdRasterPass> &raster,
               const std::optional<ChipGrid> &grid, FrameGraph &graph) {
  graph.add_before(raster ? raster_pass(on, raster, grid) : host_raster_pass(on, grid));
  if (on.path.grid == SampleGrid::distorted)
    graph.add_before(lens_search_pass(on.device, on.options.precision, on.sensor, on.facts.camera,
                                      on.request.scene, on.facts.projection.blocks,
                                      on.model.surface_vectors(on.plan.precision), on.buffers, on.scene));
  else if (on.path.points_first)
    graph.add_before(points_of(on, on.plan.precision));
}

// Sorts the pixels into classes, and sums those whose light is uniform.
void list_sorting(const FrameBasis &on, const std::shared_ptr<const PixelLists> &lists, FrameGraph &graph) {
  const PixelClass *uniform = on.path.of(PixelsOf::uniform), *refined = on.path.of(PixelsOf::uniform_refined);
  const ErrorBound &bound = on.plan.uniform_bound ? *on.plan.uniform_bound : *on.plan.bound;
  const std::uint32_t points = uniform && on.sensor.samples > 1 ? uniform->points : 0;
  graph.add_after(uniform_pixels_pass(on, on.plan.uniform_groups, on.plan.extent, bound,
                                      {.points = points,
                                       .refines = refined != nullptr,
                                       .sums = uniform != nullptr,
                                       .lists = on.path.lists_pixels(),
                                       .leaves_truth = on.path.host_reads_truth,
                                       .parts = on.path.of(PixelsOf::unshadowed) != nullptr},
                                      lists));
  if (refined)
    graph.add_after(uniform_pixels_pass(on, on.plan.uniform_groups, on.plan.extent, *refined->bound,
                                        {.points = refined->points, .leaves_truth = false}, lists));
}

// The sources that pixels of a class are summed over.
const SourceGroups &groups_of(const FramePlan &plan, const PixelClass &pixels) {
  return pixels.who == PixelsOf::precise ? *plan.precise : pixels.reduced ? plan.reduced : plan.all;
}

// Which pixels a class sums, and which it leaves to a later one.
struct ClassLists {
  const vulkan::Buffer *list = nullptr, *later = nullptr;
};

// Whether samples that are summed beforehand have to be told from those that turn away from some source, as
// no shadow pass has done so.
bool tests_facing(const FrameBasis &on, const SumScope &scope) {
  return scope.beforehand && on.path.windows == 0 && on.path.host_sum == HostSum::partial;
}

// A sum over samples that every source reaches is taken beforehand where it can be.
void add_sum(const FrameBasis &on, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
             SumScope scope, FrameGraph &graph) {
  scope.beforehand =
      on.path.point_dimensions > 0 && !scope.shadowed && !scope.by_host && scope.list == nullptr;
  scope.tests_facing = tests_facing(on, scope);
  if (scope.beforehand && on.plan.bound_beforehand)
    scope.bound =
        scope.tests_facing ? worse_of(*scope.bound, *on.plan.bound_beforehand) : on.plan.bound_beforehand;
  if (scope.depth_records && on.path.host_pixels)
    return graph.add_to_window(host_pixels_pass(on, groups, scope));
  if (scope.depth_records && on.path.direct)
    scope.output = direct_pixels(on, groups, scope);
  Pass sum = accumulate_pass(on, groups, windows, scope);
  scope.list != nullptr ? graph.add_after(std::move(sum)) : graph.add_to_window(std::move(sum));
}

// The device goes on from the host's sums, which contain the shadows already, unless the host does.
void add_host_sum(const FrameBasis &on, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
                  SumScope scope, FrameGraph &graph) {
  if (on.path.host_pixels)
    return graph.add_to_window(host_pixels_pass(on, groups, scope));
  graph.add_to_window(host_sum_pass(on, groups, scope));
  scope.by_host = true;
  scope.shadowed = false;
  add_sum(on, groups, windows, std::move(scope), graph);
}

// Depth records block by block: those that every source reaches are summed as if there were no shadows.
void sum_blocks(const FrameBasis &on, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
                const SumScope &scope, const BlockLists &lists, FrameGraph &graph) {
  const auto add = [&](std::uint32_t kind) {
    SumScope of_kind = scope;
    of_kind.shadowed = kind == shader::blocks_shaded;
    of_kind.blocks = lists.of(kind);
    if (of_kind.shadowed && on.path.host_sum == HostSum::partial)
      add_host_sum(on, groups, windows, std::move(of_kind), graph);
    else
      add_sum(on, groups, windows, std::move(of_kind), graph);
  };
  add(shader::blocks_lit);
  add(shader::blocks_shaded);
  if (on.path.direct)
    add(shader::blocks_empty);
}

// The sum over depth records: by the host, block by block, or of all at once.
void sum_records(const FrameBasis &on, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
                 SumScope scope, const BlockLists *blocks, FrameGraph &graph) {
  if (on.path.host_sum == HostSum::all)
    return add_host_sum(on, groups, windows, std::move(scope), graph);
  if (scope.shadowed)
    return sum_blocks(on, groups, windows, scope, *blocks, graph);
  add_sum(on, groups, windows, std::move(scope), graph);
}

// The passes behind that sum: its demodulation, and the claims on its pixels' errors.
void demodulate_records(const FrameBasis &on, const SourceGroups &groups, SumScope scope, FrameGraph &graph) {
  const bool settles = holds_pixels(on.modulation);
  if (on.path.direct) {
    if (settles && !on.path.host_pixels)
      graph.add_to_window(
          claims_pass(on, held_errors(on.buffers, HeldErrors::By::direct_pixels), scope.later));
    return;
  }
  if (on.plan.bound_beforehand)
    scope.bound = worse_of(*scope.bound, *on.plan.bound_beforehand);
  graph.add_after(demodulation_pass(on, groups, scope, on.path.host_reads_truth));
  if (settles)
    graph.add_after(
        claims_pass(on, held_errors(on.buffers, HeldErrors::By::demodulated_depths), scope.later));
}

// A class of pixels, sample by sample: all of them, or those of a list.
void list_class(const FrameBasis &on, PixelsOf who, const ClassLists &lists, const BlockLists *blocks,
                FrameGraph &graph) {
  const PixelClass *pixels = on.path.of(who);
  if (!pixels)
    return;
  const SourceGroups &groups = groups_of(on.plan, *pixels);
  const auto [list, later] = lists;
  SumScope scope{.shadowed = pixels->shadowed,
                 .precision = pixels->precision,
                 .list = list,
                 .later = later,
                 .looped = who == PixelsOf::precise,
                 .field = who == PixelsOf::all ? on.path.field : std::nullopt,
                 .bound = pixels->bound};
  const auto of_windows = pixels->reduced ? std::vector{all_runs(groups)} : on.windows;
  if (on.path.sums_records && who == PixelsOf::all) {
    scope.depth_records.emplace(on.device, on.sensor);
    sum_records(on, groups, of_windows, scope, blocks, graph);
    return demodulate_records(on, groups, std::move(scope), graph);
  }
  if (list && (!on.path.points_first || pixels->precision != on.plan.precision))
    graph.add_after(points_of(on, pixels->precision, list));
  add_sum(on, groups, of_windows, scope, graph);
  graph.add_after(demodulation_pass(on, groups, scope, on.path.host_reads_truth));
  if (leaves_errors(on.modulation, scope))
    graph.add_after(claims_pass(on, held_errors(on.buffers, HeldErrors::By::demodulated_samples), later));
}

// Counts the work of the classes that follow, for which the last one has listed pixels.
Pass count_pass(const std::shared_ptr<const PixelLists> &lists) {
  return {.name = "accumulate",
          .reads = pixel_lists,
          .writes = pixel_lists,
          .record = [lists](const Recording &at) {
            const std::uint32_t side = at.of_strip().samples;
            lists->record_count(at.commands, side * side);
          }};
}

Pass clear_pass(const std::shared_ptr<const PixelLists> &lists) {
  return {.name = "accumulate",
          .reads = no_resource,
          .writes = pixel_lists,
          .record = [lists](const Recording &at) { lists->record_clear(at.commands); }};
}

// The classes of pixels, one after the other, each with the pixels that those before it have left.
void list_classes(const FrameBasis &on, const BlockLists *blocks, FrameGraph &graph) {
  const PixelClass *precise = on.path.of(PixelsOf::precise);
  std::shared_ptr<const PixelLists> lists;
  if (on.path.is_sorted() || precise)
    lists = std::make_shared<const PixelLists>(on.device, on.strips);
  const vulkan::Buffer *of_precise = precise ? &lists->of(shader::list_precise) : nullptr;
  if (!on.path.is_sorted()) {
    if (precise) // of one window
      graph.add_to_window(clear_pass(lists));
    list_class(on, PixelsOf::all, {nullptr, of_precise}, blocks, graph);
  } else {
    const vulkan::Buffer *of_rest = &lists->of(shader::list_rest);
    list_sorting(on, lists, graph);
    list_class(on, PixelsOf::unshadowed, {&lists->of(shader::list_unshadowed), precise ? of_rest : nullptr},
               nullptr, graph);
    if (precise)
      graph.add_after(count_pass(lists));
    list_class(on, PixelsOf::rest, {of_rest, of_precise}, nullptr, graph);
  }
  if (precise) {
    graph.add_after(count_pass(lists));
    list_class(on, PixelsOf::precise, {of_precise, nullptr}, nullptr, graph);
  }
}

// Some pixels of a strip again, with every sample and source. The bits of the last window are still there.
void list_check(const FrameBasis &on, const SpotCheck &check, const ShadowPasses &shadow, FrameGraph &graph) {
  Modulation modulation = on.modulation;
  modulation.keeps_terms = modulation.reports_kept = false;
  const PassSetup setup{on.device, on.options, on.sensor, modulation, on.model, on.buffers, on.scene};
  const Precision precision = *on.path.check;
  SourceGroups of_precision;
  if (precision != on.plan.precision && !on.plan.precise)
    of_precision = group_diodes(on.facts.lights, on.facts.projection.visible,
                                modulation.largest_wavenumber_rad_m(), precision);
  const SourceGroups &groups = precision == on.plan.precision ? on.plan.all
                               : on.plan.precise              ? *on.plan.precise
                                                              : of_precision;
  const SumScope scope{.shadowed = modulation.lit,
                       .precision = precision,
                       .list = &check.list(),
                       .looped = on.plan.precise && precision == Precision::fp64};
  graph.add_before(check.list_pass());
  if (on.path.grid != SampleGrid::distorted)
    graph.add_before(points_of(on, precision, &check.list()));
  if (shadow && on.windows.size() > 1)
    list_shadow_passes(on, shadow, graph);
  graph.add_to_window(
      accumulate_pass(setup, groups, shadow ? on.windows : std::vector{all_runs(groups)}, scope));
  graph.add_after(demodulation_pass(setup, groups, scope));
  Pass read_back = read_back_pass(on.sensor, on.modulation, on.buffers, {});
  read_back.store = {}; // it is only compared
  graph.add_after(std::move(read_back));
}

// The part of the report that is known before the frame.
AccuracyReport report_of(const FramePlan &plan, const FramePath &path) {
  AccuracyReport report;
  report.precision = plan.precision;
  report.diodes = shining_diodes(path.classes.front().reduced ? plan.reduced : plan.all);
  report.claimed_m = plan.claimed_m;
  report.claimed_amplitude = plan.claimed_amplitude;
  return report;
}

FramePasses make_passes(const FrameBasis &on, std::unique_ptr<FrameMemory> memory,
                        std::optional<RasterImages> images) {
  std::optional<ChipGrid> grid;
  if (on.path.record == SampleRecord::depth)
    grid.emplace(on.device, on.sensor);
  std::shared_ptr<IdRasterPass> raster;
  if (!on.path.host_raster)
    raster =
        std::make_shared<IdRasterPass>(on.device, on.facts.projection, on.sensor, on.strips, on.scene,
                                       on.options.precision, grid, drawn_ids(on.buffers), std::move(images));
  const auto sources = std::make_shared<const SourceGroups>(on.plan.all);
  const ShadowPasses shadow = make_shadow_passes(on, grid);
  std::optional<TruthOfRecords> truth;
  if (on.path.host_reads_truth)
    truth = truth_of_records(on.device, on.options, on.request.scene);

  FramePasses made{on.path, on.sensor,         on.modulation, on.strips, on.windows.size(),
                   sources, std::move(memory), raster,        {},        report_of(on.plan, on.path)};
  FrameGraph &graph = made.graph;
  list_view(on, raster, grid, graph);
  if (shadow)
    list_shadow_passes(on, shadow, graph);
  if (shadow && on.options.keep_visibility)
    graph.add_to_window(visibility_read_back_pass(on, sources));
  list_classes(on, shadow.blocks.get(), graph);
  graph.add_after(read_back_pass(on.sensor, on.modulation, on.buffers, truth,
                                 on.facts.counts_electrons ? LightBy::electrons : LightBy::read_back));
  if (on.facts.counts_electrons)
    graph.add_after(electrons_pass(on.sensor, on.modulation, on.options, on.buffers));
  if (on.path.check) {
    made.check.emplace(on, on.strips);
    list_check(on, *made.check, shadow, made.check_graph);
  }
  return made;
}

} // namespace

FramePasses make_passes(const vulkan::Device &device, const SimulatorOptions &options,
                        const FrameRequest &request, std::uint32_t attempt, TextureCache &textures,
                        SpareMemory &&spare) {
  FrameFacts facts = look(device, options, request);
  const FramePlan plan = plan_frame({facts.lights, facts.projection.visible, request.sensor, facts.modulation,
                                     facts.model, request.backscatter, device.is_cpu(), options.allowed,
                                     facts.paint.painted, facts.window_bundles},
                                    request.accuracy, attempt);
  facts.modulation.keeps_terms = plan.bound.has_value();
  facts.modulation.keeps_beams = plan.bound && plan.has_beams();
  facts.modulation.reports_kept = plan.bound && !plan.surely_kept;
  facts.modulation.keeps_bounds = plan.bound && options.keep_error_bound;
  const std::vector<SourceWindow> windows =
      facts.modulation.lit ? plan_windows(plan.all, facts.window_bundles) : std::vector{all_runs(plan.all)};
  const auto planes = planes_of(facts, request);
  const auto backscatter = one_backscatter(facts.camera, planes);
  const FramePath path = choose_path(facts, plan, request, windows.size(), backscatter, options.allowed);
  facts.modulation.complex_returns = options.allowed.complex_returns && facts.counts_electrons &&
                                     path.host_pixels && !facts.modulation.keeps_terms;
  const std::uint32_t words = visibility_words(facts, windows);
  const std::uint32_t largest_strip = std::min(facts.largest_strip, samples_of_words(words));
  const std::vector<PlannedStrip> strips =
      plan_strips(request.sensor, facts.projection.blocks,
                  options.max_strip_samples > 0 ? options.max_strip_samples : largest_strip);
  auto memory = std::make_unique<FrameMemory>(FrameMemory{
      make_strip_buffers(device, strips, facts.projection.blocks,
                         layout_of(options, facts, plan, path, words), options, std::move(spare.buffers)),
      {vulkan::upload(device, planes),
       upload_paint(device, facts.paint, facts.camera, request.scene, request.backscatter, textures),
       path.one_backscatter ? backscatter : std::nullopt, facts.camera.world_rounding_m}});
  const FrameBasis on{
      {device, options, request.sensor, facts.modulation, facts.model, memory->buffers, memory->scene},
      request,
      facts,
      plan,
      path,
      strips,
      windows};
  return make_passes(on, std::move(memory), std::move(spare.images));
}

} // namespace pmdsim
