#pragma once
// The shadow pass: which diodes reach which sample, by the silhouettes that the light's place crosses on its
// way from the lens to a diode (docs/theory.md).

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

class SweepPass {
public:
  // `records`: given where samples are depth records. Throws Error (out_of_memory).
  SweepPass(const PassSetup &on, const Occluders &occluders, const CameraScene &camera, const Scene &scene,
            const SourceGroups &groups, const std::vector<SourceWindow> &windows,
            std::span<const PlannedStrip> strips, const std::optional<ChipGrid> &records);
  ~SweepPass();

  // Leaves the window's bits in the strip's visibility, and in `lit` how many diodes of this window and all
  // that follow reach a sample.
  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip, std::size_t window) const;

  // Whether has_lost() may ever be true.
  bool may_lose() const;
  // Once the device is done with a strip: whether there were more edges in a tile's way than the shaders'
  // loops can take, so that the bits are not all right.
  bool has_lost() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pmdsim
