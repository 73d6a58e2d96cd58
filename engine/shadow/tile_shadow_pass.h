#pragma once
// The shadow pass: which diodes reach which sample. Parts of tiles and bundles of diodes first, all at once
// and never wrong; samples and diodes one by one only where that leaves a doubt.

#include "engine/light/source_windows.h"
#include "engine/sampling/strip_memory.h"
#include "engine/shadow/occluders.h"
#include "engine/view/surface_appearance.h"
#include "engine/vulkan/compute_pipeline.h"

#include <span>
#include <vector>

namespace pmdsim {

// A window's diodes on the device.
struct LitDiodes {
  vulkan::Buffer boxes, bundles, bits; // as in WindowDiodes
};

// The scene on the device.
struct LitScene {
  std::uint32_t nodes; // of the tree
  vulkan::Buffer occluders, tree, bodies;
  vulkan::Buffer record; // shader::LitScene
};

// The shaders, compiled for a device and a scene.
struct LitPipelines {
  vulkan::ComputePipeline tiles; // in the order in which they run
  vulkan::ComputePipeline open;
  vulkan::ComputePipeline gather;
  vulkan::ComputePipeline attempt;
  vulkan::ComputePipeline clear;
  vulkan::ComputePipeline trace;
  vulkan::ComputePipeline walk;                // `trace` of walks that were too long
  std::vector<vulkan::ComputePipeline> counts; // of each window
};

class TileShadowPass {
public:
  // `tiled`: the IDs lie in tiles (shaders/shared/interface.h). Throws Error (out_of_memory).
  TileShadowPass(const vulkan::Device &device, const Occluders &occluders, const SourceGroups &groups,
                 const std::vector<SourceWindow> &windows, const SceneBuffers &scene,
                 std::span<const PlannedStrip> strips, bool tiled, SamplePrecision precision);

  // Cuts the strip into tiles, once for all windows.
  void record_tiles(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                    const StripBuffers &buffers) const;
  // Leaves the window's bits in buffers.visibility and adds its diodes to buffers.lit.
  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, std::size_t window) const;

private:
  shader::LitGatherConstants gather_constants(const shader::Strip &strip, const StripBuffers &buffers,
                                              std::size_t window) const;
  // One bundle of the window.
  void record_decide(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                     const StripBuffers &buffers, std::size_t window, std::uint32_t bundle) const;
  void record_count(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                    const StripBuffers &buffers, std::size_t window) const;

  std::vector<SourceWindow> windows_;
  std::vector<LitDiodes> diodes_; // beside windows_
  std::uint32_t slots_;           // of candidates_
  LitScene scene_;
  vulkan::Buffer parts_, work_, candidates_;
  LitPipelines pipelines_;
};

} // namespace pmdsim
