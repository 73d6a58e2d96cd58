#pragma once
// The accumulate pass: every sample of its pixels times every source, run by run of sources, in a fixed
// order. It sums by moments, which serve every tone at once, or, where light is square, diode by diode for
// one frequency at a time.

#include "engine/light/source_windows.h"
#include "engine/light/sum_model.h"
#include "engine/light/tones.h"
#include "engine/model/accuracy.h"
#include "engine/model/simulator_options.h"
#include "engine/sampling/block_lists.h"
#include "engine/sampling/pass.h"
#include "engine/sampling/sample_grid.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/surface_appearance.h"
#include "engine/vulkan/shader_module.h"

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace pmdsim {

// The things that passes are made of: the device, what is measured, and the memory in which passes meet,
// which has to stay in its place while they are used.
struct PassSetup {
  const vulkan::Device &device;
  const SimulatorOptions &options;
  const Sensor &sensor;
  const Modulation &modulation;
  const SumModel &model;
  const StripBuffers &buffers;
  const SceneBuffers &scene;
};

// Where the sum goes instead of its planes: a shader of its own, which makes channels of it at once.
struct SumOutput {
  std::string_view module;
  vulkan::Specialization constants; // beside the sum's
  vulkan::Buffer record;            // what DepthSumConstants::sum leads to
};

// Which samples are summed, and how exactly.
struct SumScope {
  bool shadowed = false;                 // not every diode reaches every sample
  bool beforehand = false;               // the diodes are summed beforehand (point_polynomials.h)
  bool tests_facing = false;             // but for samples that turn away from some diode
  bool by_host = false;                  // the diodes are summed by the host (host/host_sum.h)
  Precision precision = Precision::fp32; // of the groups and of the surfaces' vectors
  const vulkan::Buffer *list = nullptr;  // of pixels; else all
  const vulkan::Buffer *later =
      nullptr;         // of pixels that may be beyond the bound, for a later class; else none
  bool looped = false; // a loop, as few pixels are not worth compiling a straight line
  std::optional<InterpolatedField> field{};  // else each sample has sums of its own
  std::optional<ErrorBound> bound{};         // the bound that the sum's error is held against
  std::optional<ChipGrid> depth_records{};   // where these are all that is known of the samples
  std::optional<SampleBlocks> blocks{};      // of depth records, only these
  std::shared_ptr<const SumOutput> output{}; // of depth records
};

// `windows` hold the runs of `groups`, and where `shadowed` their visibility bits.
Pass accumulate_pass(const PassSetup &on, const SourceGroups &groups,
                     const std::vector<SourceWindow> &windows, const SumScope &scope);

// Each run's record of what its diodes share, as the shaders read it. The rounding of some weights beyond the
// bound counts as light.
std::vector<shader::LightRun> light_runs(const SourceGroups &groups, const ErrorBound &bound,
                                         bool beforehand = false);

// Whether what is kept of the terms counts the ends of beams.
bool has_beam_edges(const SumModel &model, const std::optional<ErrorBound> &bound);

// Specialization constants of the sum's forms, and the diodes that they read.
vulkan::Specialization sum_constants(const PassSetup &on, const SourceGroups &groups, const SumScope &scope);
vulkan::Buffer upload_diodes(const vulkan::Device &device, const SourceGroups &groups, const SumScope &scope);

} // namespace pmdsim
