#pragma once
// The lit pass: which diodes reach which sample. Parts of tiles and bundles of diodes first, all at once and
// never wrong; samples and diodes one by one only where that leaves a doubt.

#include "engine/passes/lit_windows.h"
#include "engine/passes/occluders.h"
#include "engine/passes/scene_buffers.h"
#include "engine/passes/strip_buffers.h"
#include "engine/simulator_options.h"
#include "engine/vulkan/compute_pipeline.h"

#include <span>

namespace pmdsim {

class LitPass {
public:
  // `tiled`: whether the tags lie in tiles (shaders/interface.h). Throws Error (out_of_memory).
  LitPass(const vulkan::Device &device, const Occluders &occluders, const DiodeGroups &groups,
          const std::vector<LitWindow> &windows, const SceneBuffers &scene,
          std::span<const PlannedStrip> strips, bool tiled, SamplePrecision precision);

  // Cuts the strip into tiles, once for all windows.
  void record_tiles(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                    const StripBuffers &buffers) const;
  // Leaves the window's bits in buffers.reached and adds its diodes to buffers.lit.
  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, std::size_t window) const;

private:
  // A window's diodes on the device.
  struct Diodes {
    vulkan::Buffer boxes, bundles, bits;
  };

  void record_gather(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                     const StripBuffers &buffers, std::size_t window) const;
  void record_decide(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                     const StripBuffers &buffers, std::size_t window) const;
  void record_count(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                    const StripBuffers &buffers, std::size_t window) const;

  std::vector<LitWindow> windows_;
  std::vector<Diodes> diodes_; // beside windows_
  std::uint32_t nodes_;
  std::uint32_t slots_;
  vulkan::Buffer occluders_, tree_, bodies_, scene_;
  vulkan::Buffer parts_, work_, candidates_;
  vulkan::ComputePipeline tiles_, open_, gather_, try_, trace_, walk_;
  std::vector<vulkan::ComputePipeline> count_; // beside windows_
};

} // namespace pmdsim
