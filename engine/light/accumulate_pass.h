#pragma once
// The accumulate pass, `exact`: every sample times every diode, run by run of diodes, in a fixed order. By
// moments, which serve every tone at once, or diode by diode for one frequency at a time.

#include "engine/light/source_windows.h"
#include "engine/light/sum_model.h"
#include "engine/light/tones.h"
#include "engine/model/error_bound.h"
#include "engine/model/simulator_options.h"
#include "engine/sampling/pixel_lists.h"
#include "engine/sampling/sample_grid.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/surface_appearance.h"
#include "engine/vulkan/compute_pipeline.h"

#include <optional>

namespace pmdsim {

class AccumulatePass {
public:
  // `shadowed`: not every diode reaches every sample; `listed`: only of lists of pixels; `precision` is the
  // one of the groups and of the surfaces' vectors; `promise`: what the sum's error is to be held against.
  struct Scope {
    bool shadowed = false, listed = false;
    Precision precision = Precision::fp32;
    std::optional<Promise> promise{};
    std::optional<ChipGrid> plain{}; // where the samples' records are all that is known of them
  };
  AccumulatePass(const vulkan::Device &device, const DiodeGroups &groups, const SumModel &model,
                 const Signal &signal, const SimulatorOptions &options, const Scope &scope);

  std::uint32_t runs() const { return static_cast<std::uint32_t>(runs_.size()); }
  // Interactions (samples times diodes, padding included) of one run over `strip`.
  std::uint64_t interactions_per_run(const shader::Strip &strip) const;
  // Adds the runs first ... last - 1 of the window to the strip's sums.
  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, const SceneBuffers &scene, const LitWindow &window,
              std::uint32_t first, std::uint32_t last, const vulkan::Buffer *list = nullptr) const;

private:
  void record_plain(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                    const StripBuffers &buffers, const SceneBuffers &scene, std::uint32_t run) const;

  std::optional<ChipGrid> plain_;
  std::vector<DiodeRun> runs_;
  vulkan::Buffer light_runs_; // shader::LightRun of each
  std::uint32_t blocks_per_run_;
  std::uint32_t bundles_per_run_;
  std::uint32_t dispatches_; // a run: one by moments, else one for each frequency
  std::uint32_t planes_;     // of the sum, of each frequency
  vulkan::Buffer tones_;
  vulkan::Buffer diodes_;
  vk::DeviceSize diode_bytes_; // of each
  vulkan::Buffer diagrams_;
  vulkan::ComputePipeline first_; // the first of a frame's runs; on the plain way all
  vulkan::ComputePipeline later_; // all the others; empty where there are none
};

// What the runs' diodes share, as the shaders read it. What rounding does to some weights beyond the
// promise's bound counts as light.
std::vector<shader::LightRun> light_runs(const DiodeGroups &groups, const Promise &promise);

// Of the moments' forms and what they share with other sums: specialization constants, and the diodes and
// tones that they read.
vulkan::Specialization sum_constants(const vulkan::Device &device, const SimulatorOptions &options,
                                     const DiodeGroups &groups, const SumModel &model, const Signal &signal,
                                     const AccumulatePass::Scope &scope);
vulkan::Buffer upload_diodes(const vulkan::Device &device, const DiodeGroups &groups,
                             const AccumulatePass::Scope &scope);
vulkan::Buffer upload_tones(const vulkan::Device &device, const Signal &signal);

} // namespace pmdsim
