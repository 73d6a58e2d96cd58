#include "engine/frame/shadow_passes.h"

#include "engine/model/error.h"
#include "engine/shadow/visibility_bits.h"
#include "engine/vulkan/commands.h"

namespace pmdsim {
namespace {

Pass sweep_pass(Resources samples, const std::shared_ptr<const SweepPass> &sweep) {
  Pass pass{.name = "lit",
            .reads = samples,
            .writes = visibility_bits | visibility_counts,
            .record = [=](const Recording &at) { sweep->record(at.commands, at.of_strip(), at.window); }};
  if (sweep->may_lose())
    pass.store = [=](const Recording &, Measurement &) {
      if (sweep->has_lost())
        throw Error(ExitCode::out_of_memory, "shadows: expected fewer edges in the light of a sample");
    };
  return pass;
}

// `blocks`: given where it lists them, too.
Pass host_sweep_pass(Resources samples, const std::shared_ptr<const HostSweep> &sweep,
                     const std::shared_ptr<const BlockLists> &blocks) {
  return {.name = "lit",
          .reads = samples,
          .writes = visibility_bits | visibility_counts | block_lists,
          .record = [](const Recording &at) { vulkan::host_barrier(at.commands); },
          .store =
              [=](const Recording &at, Measurement &) {
                sweep->decide(at.of_strip(), at.window);
                if (blocks)
                  blocks->write(at.of_strip(), sweep->block_kinds());
              }};
}

} // namespace

ShadowPasses make_shadow_passes(const FrameBasis &on, const std::optional<ChipGrid> &grid) {
  ShadowPasses shadow;
  const FrameFacts &facts = on.facts;
  if (on.path.windows == 0)
    return shadow;
  if (on.path.host_sweep)
    shadow.host = std::make_shared<const HostSweep>(
        on, facts.occluders, facts.camera, on.request.scene, on.plan.all, on.windows, grid,
        !on.path.keeps_depths_only() || on.path.host_sum == HostSum::all || on.path.holes || on.path.check ||
            on.options.keep_visibility);
  else
    shadow.sweep = std::make_shared<const SweepPass>(on, facts.occluders, facts.camera, on.request.scene,
                                                     on.plan.all, on.windows, on.strips, grid);
  if (on.path.holes)
    shadow.holes = std::make_shared<const HolesPass>(on, facts.occluders.with_holes, on.plan.all, on.windows,
                                                     on.strips, grid);
  if (on.path.sums_records && on.path.host_sum != HostSum::all)
    shadow.blocks = std::make_shared<const BlockLists>(on.device, on.buffers, on.strips,
                                                       shining_diodes(on.plan.all), on.path.direct);
  return shadow;
}

void list_shadow_passes(const FrameBasis &on, const ShadowPasses &shadow, FrameGraph &graph) {
  const Resources samples = on.path.record == SampleRecord::depth ? Resources{ids} : ids | points;
  const bool host_lists = shadow.host && !shadow.holes;
  graph.add_to_window(shadow.host
                          ? host_sweep_pass(samples, shadow.host, host_lists ? shadow.blocks : nullptr)
                          : sweep_pass(samples, shadow.sweep));
  if (shadow.holes)
    graph.add_to_window({.name = "lit",
                         .reads = samples | visibility_bits,
                         .writes = visibility_bits | visibility_counts,
                         .record = [holes = shadow.holes](const Recording &at) {
                           holes->record(at.commands, at.of_strip(), at.window);
                         }});
  if (shadow.blocks && !host_lists)
    graph.add_to_window({.name = "lit",
                         .reads = ids | visibility_counts,
                         .writes = block_lists,
                         .record = [blocks = shadow.blocks](const Recording &at) { blocks->record(at); }});
}

Pass visibility_read_back_pass(const FrameBasis &on, const std::shared_ptr<const SourceGroups> &sources) {
  const bool row_by_row = on.path.record == SampleRecord::depth;
  return {.name = "read_back",
          .reads = visibility_bits,
          .writes = no_resource,
          .record =
              [=, &buffers = on.buffers, windows = on.windows](const Recording &at) {
                record_visibility(at.commands, at.of_strip(), buffers, windows[at.window]);
              },
          .store =
              [=, &buffers = on.buffers, windows = on.windows](const Recording &at, Measurement &to) {
                store_visibility(at.of_strip(), buffers, windows[at.window], *sources, row_by_row,
                                 to.sample_visibility);
              }};
}

} // namespace pmdsim
