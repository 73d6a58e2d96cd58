#pragma once
// The resolve pass: sums a pixel's samples and makes its phase, amplitude, distance, taps and ground truth.

#include "engine/light/source_groups.h"
#include "engine/light/tones.h"
#include "engine/model/accuracy.h"
#include "engine/model/error_bound.h"
#include "engine/model/simulator_options.h"
#include "engine/sampling/pixel_lists.h"
#include "engine/sampling/sample_grid.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/surface_appearance.h"
#include "engine/vulkan/compute_pipeline.h"

#include <optional>

namespace pmdsim {

class ResolvePass {
public:
  // Of samples that were summed the plain way (AccumulatePass::Scope).
  struct PlainScope {
    ChipGrid grid;
    std::uint32_t samples; // S
    bool single_run;
    bool vignetting, painted;
    bool one_backscatter;  // that of SceneBuffers
    bool truth_of_records; // leaves to the host what TruthOfRecords tells
  };
  // Which pixels, and how they were summed.
  struct Scope {
    bool tiled = false;  // the tags lie in tiles (shaders/shared/interface.h)
    bool listed = false; // only those of lists
    Precision precision = Precision::fp32;
    std::optional<Promise> promise{}; // where Signal::promised
    std::optional<PlainScope> plain{};
  };
  ResolvePass(const vulkan::Device &device, const Signal &signal, const DiodeGroups &groups,
              const SimulatorOptions &options, const Scope &scope);

  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, const SceneBuffers &scene,
              const vulkan::Buffer *list = nullptr) const;

private:
  void record_plain(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                    const StripBuffers &buffers, const SceneBuffers &scene,
                    std::uint32_t first_frequency) const;

  Signal signal_;
  std::optional<PlainScope> plain_;
  std::uint32_t diodes_;
  vulkan::Buffer frequencies_;
  vulkan::Buffer harmonics_;
  vulkan::ComputePipeline first_; // of the frequencies: stores the ground truth, too
  vulkan::ComputePipeline later_; // all the others; empty where there are none
};

// The specialization constants of the resolve pass, for what resolves likewise.
vulkan::Specialization resolve_constants(const Signal &signal, const ResolvePass::Scope &scope, bool first);

} // namespace pmdsim
