#pragma once
// The resolve pass: sums a pixel's samples and makes its phase, amplitude, distance, taps and ground truth.

#include "engine/passes/diode_groups.h"
#include "engine/passes/signal.h"
#include "engine/passes/strip_buffers.h"
#include "engine/simulator_options.h"
#include "engine/vulkan/compute_pipeline.h"

namespace pmdsim {

class ResolvePass {
public:
  // `tiled`: whether the tags lie in tiles (shaders/interface.h); `sum` is the precision of the sum.
  ResolvePass(const vulkan::Device &device, const Signal &signal, const DiodeGroups &groups, bool tiled,
              SamplePrecision precision, Precision sum = Precision::fp32);

  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, const vulkan::Buffer &planes) const;

private:
  Signal signal_;
  float amplitude_scale_;
  std::uint32_t diodes_;
  vulkan::Buffer harmonics_;
  vulkan::ComputePipeline first_; // of the frequencies: stores the ground truth, too
  vulkan::ComputePipeline later_; // all the others; empty where there are none
};

} // namespace pmdsim
