#pragma once
// The sweep on the host, for devices that are its processor: the same decisions as SweepPass's shaders make,
// in its widest vectors, straight in the memory that both share.

#include "engine/light/accumulate_pass.h"
#include "engine/light/source_windows.h"
#include "engine/sampling/sample_grid.h"
#include "engine/shadow/boards.h"
#include "engine/shadow/occluders.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace pmdsim {

class HostSweep {
public:
  // As SweepPass, for a device whose memory the host reads and writes as its own. `fills_all`: the bits of
  // tiles all of whose samples every diode reaches are read, too.
  HostSweep(const PassSetup &on, const Occluders &occluders, const CameraScene &camera, const Scene &scene,
            const SourceGroups &groups, const std::vector<SourceWindow> &windows,
            const std::optional<ChipGrid> &records, bool fills_all);
  ~HostSweep();

  // As SweepPass::record(), at once; the device is done with the samples.
  void decide(const shader::Strip &strip, std::size_t window) const;

  // The kind of each block (BlockLists) of the strip and window last decided, row by row; only where samples
  // are records.
  std::span<const std::uint8_t> block_kinds() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pmdsim
