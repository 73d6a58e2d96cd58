#pragma once
// The shadow pass: which diodes reach which sample, by the silhouettes that the light's place crosses on its
// way from the lens to a diode (docs/theory.md).

#include "engine/light/source_windows.h"
#include "engine/sampling/strip_memory.h"
#include "engine/shadow/boards.h"
#include "engine/shadow/occluders.h"
#include "engine/view/surface_appearance.h"
#include "engine/vulkan/compute_pipeline.h"

#include <memory>
#include <span>
#include <vector>

namespace pmdsim {

class SweepPass {
public:
  // `tiled`: the IDs lie in tiles (shaders/shared/interface.h). Throws Error (out_of_memory).
  SweepPass(const vulkan::Device &device, const Occluders &occluders, const CameraScene &camera,
            const Scene &scene, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
            const SceneBuffers &buffers, std::span<const PlannedStrip> strips, bool tiled, bool all_facing,
            SamplePrecision precision);
  ~SweepPass();

  // Leaves the window's bits in buffers.visibility and adds its diodes to buffers.lit.
  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, std::size_t window) const;

  // Whether a strip's lists may be too long for the rounds that they are made in.
  bool may_overflow() const;
  // Once the device is done with a strip. Throws Error (out_of_memory) where they were.
  void check() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pmdsim
