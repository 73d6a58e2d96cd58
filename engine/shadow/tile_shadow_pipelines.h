#pragma once
// The shaders of the lit pass, compiled for a device and a scene.

#include "engine/light/source_windows.h"
#include "engine/model/simulator_options.h"
#include "engine/vulkan/compute_pipeline.h"
#include "shaders/shadow/lit_interface.h"

namespace pmdsim {

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

// What is compiled in or out.
struct LitForm {
  bool tiled;   // the IDs lie in tiles (shaders/shared/interface.h)
  bool cutouts; // occluders may have holes
  bool flat;    // within a bundle all diodes have the same z
};

LitPipelines make_lit_pipelines(const vulkan::Device &device, const std::vector<SourceWindow> &windows,
                                const LitForm &form, SamplePrecision precision);

} // namespace pmdsim
