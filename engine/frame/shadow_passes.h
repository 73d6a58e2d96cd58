#pragma once
// The passes that find which sources reach which sample, as the frame's path asks for them.

#include "engine/frame/frame_basis.h"
#include "engine/frame/frame_graph.h"
#include "engine/shadow/holes_pass.h"
#include "engine/shadow/host/host_sweep.h"
#include "engine/shadow/sweep_pass.h"

#include <memory>
#include <optional>
#include <vector>

namespace pmdsim {

// None where every source reaches every sample.
struct ShadowPasses {
  std::shared_ptr<const SweepPass> sweep;
  std::shared_ptr<const HostSweep> host; // in its place
  std::shared_ptr<const HolesPass> holes;
  std::shared_ptr<const BlockLists> blocks; // of depth records, for the sum

  explicit operator bool() const { return sweep || host; }
};

ShadowPasses make_shadow_passes(const FrameBasis &on, const std::optional<ChipGrid> &grid);

// Adds the shadow passes to each window's passes.
void list_shadow_passes(const FrameBasis &on, const ShadowPasses &shadow, FrameGraph &graph);

// Brings the bits to the host.
Pass visibility_read_back_pass(const FrameBasis &on, const std::shared_ptr<const SourceGroups> &sources);

} // namespace pmdsim
