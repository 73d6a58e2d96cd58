#pragma once
// The resolve pass: sums a pixel's samples and makes its phase, amplitude, distance and ground truth.

#include "engine/passes/strip_buffers.h"
#include "engine/sensor.h"
#include "engine/simulator_options.h"
#include "engine/vulkan/compute_pipeline.h"

namespace pmdsim {

class ResolvePass {
public:
  ResolvePass(const vulkan::Device &device, const Sensor &sensor, double largest_intensity_w_sr,
              SamplePrecision precision);

  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, const vulkan::Buffer &planes) const;

private:
  double ambiguity_m_;
  float amplitude_scale_;
  vulkan::ComputePipeline pipeline_;
};

} // namespace pmdsim
