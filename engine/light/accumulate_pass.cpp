#include "engine/light/accumulate_pass.h"

#include "engine/vulkan/commands.h"
#include "engine/vulkan/float_pair.h"
#include "engine/vulkan/forms.h"
#include "spirv/accumulate_looped_double_float.h"
#include "spirv/accumulate_looped_fp64.h"
#include "spirv/accumulate_per_diode_looped_double_float.h"
#include "spirv/accumulate_per_diode_looped_fp64.h"
#include "spirv/accumulate_per_diode_straight_double_float.h"
#include "spirv/accumulate_per_diode_straight_fp64.h"
#include "spirv/accumulate_plain_looped_double_float.h"
#include "spirv/accumulate_plain_looped_fp64.h"
#include "spirv/accumulate_plain_straight_double_float.h"
#include "spirv/accumulate_plain_straight_fp64.h"
#include "spirv/accumulate_precise_looped_double_float.h"
#include "spirv/accumulate_precise_looped_fp64.h"
#include "spirv/accumulate_precise_straight_fp64.h"
#include "spirv/accumulate_straight_double_float.h"
#include "spirv/accumulate_straight_fp64.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

// What rounding does to a diode's height over a surface: this often u, 2^-24 of float and 2^-45 of fp64,
// times the size of the light with its distance from the lens.
constexpr double height_rounding = 14.0;
const Forms moment_forms{shader::accumulate_straight_fp64_spirv,
                         shader::accumulate_straight_double_float_spirv, shader::accumulate_looped_fp64_spirv,
                         shader::accumulate_looped_double_float_spirv};
const Forms plain_forms{
    shader::accumulate_plain_straight_fp64_spirv, shader::accumulate_plain_straight_double_float_spirv,
    shader::accumulate_plain_looped_fp64_spirv, shader::accumulate_plain_looped_double_float_spirv};
const Forms direct_forms{shader::accumulate_per_diode_straight_fp64_spirv,
                         shader::accumulate_per_diode_straight_double_float_spirv,
                         shader::accumulate_per_diode_looped_fp64_spirv,
                         shader::accumulate_per_diode_looped_double_float_spirv};
// Pairs of floats as a straight line would take minutes to compile.
const Forms precise_forms{
    shader::accumulate_precise_straight_fp64_spirv, shader::accumulate_precise_looped_double_float_spirv,
    shader::accumulate_precise_looped_fp64_spirv, shader::accumulate_precise_looped_double_float_spirv};

const Forms &forms_of(const Signal &signal, const AccumulatePass::Scope &scope) {
  if (scope.plain)
    return plain_forms;
  return !signal.by_moments                   ? direct_forms
         : scope.precision == Precision::fp64 ? precise_forms
                                              : moment_forms;
}

} // namespace

vulkan::Buffer upload_tones(const vulkan::Device &device, const Signal &signal) {
  const std::vector<shader::Tone> tones = signal.all_tones();
  return vulkan::upload(device, std::as_bytes(std::span(tones)));
}

namespace {

bool sums_alike(const DiodeGroups &groups, const AccumulatePass::Scope &scope) {
  return groups.power_sums.alike && !scope.shadowed;
}

} // namespace

vulkan::Buffer upload_diodes(const vulkan::Device &device, const DiodeGroups &groups,
                             const AccumulatePass::Scope &scope) {
  if (scope.precision == Precision::fp64)
    return vulkan::upload(device, std::as_bytes(std::span(groups.precise_diodes)));
  if (!sums_alike(groups, scope))
    return vulkan::upload(device, std::as_bytes(std::span(groups.diodes)));
  std::vector<shader::vec4> positions(groups.diodes.size());
  std::ranges::transform(groups.diodes, positions.begin(), &shader::GroupDiode::position);
  return vulkan::upload(device, std::as_bytes(std::span(positions)));
}

vulkan::Specialization sum_constants(const DiodeGroups &groups, const SumModel &model, const Signal &signal,
                                     const AccumulatePass::Scope &scope, bool first) {
  return {groups.moments,
          model.backscatter,
          model.pattern,
          model.order,
          groups.blocks_per_run,
          first ? 1u : 0u,
          signal.tones * signal.frequencies(),
          signal.waveform,
          signal.taps,
          signal.distinct_taps,
          groups.phased ? 1u : 0u,
          scope.shadowed ? 1u : 0u,
          scope.listed ? 1u : 0u,
          signal.promised ? 1u : 0u,
          groups.power_sums.powers,
          sums_alike(groups, scope) ? 1u : 0u,
          groups.power_sums.planar ? 1u : 0u};
}

namespace {

vulkan::ComputePipeline make_pipeline(const vulkan::Device &device, const DiodeGroups &groups,
                                      const SumModel &model, const Signal &signal,
                                      const SimulatorOptions &options, const AccumulatePass::Scope &scope,
                                      bool first) {
  vulkan::Specialization constants = sum_constants(groups, model, signal, scope, first);
  if (scope.plain) {
    constants.push_back(groups.runs.size() == 1 ? 1u : 0u);
    constants.push_back(scope.plain->is_nominal() ? 0u : 1u);
  }
  const std::size_t bytes =
      scope.plain ? sizeof(shader::PlainSumConstants) : sizeof(shader::AccumulateConstants);
  return {device, forms_of(signal, scope).choose(device, options), static_cast<std::uint32_t>(bytes),
          constants};
}

// At least n of cos^n. Below 1 as much as n cos^(n - 1) comes to down to cos = 10^-3, where such a beam ends
// as a step.
double steepness(double order) { return order < 1.0 ? 54.0 : order; }

// What a run's diodes at `first` to `last` - 1 come to where their beams end (rim_terms in
// shaders/light/sum.glsl).
void set_rims(const DiodeGroups &groups, std::size_t first, std::size_t last, const Promise &promise,
              shader::LightRun &record) {
  double steepest = 0.0, least_order = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; ++i) {
    const auto order = static_cast<double>(groups.diodes[i].order);
    if (order <= 0.0) // no cosine, or a half-space
      continue;
    steepest = std::max(steepest, steepness(order));
    least_order = std::min(least_order, std::max(order, 1.0));
  }
  record.rims = static_cast<float>(promise.terms_of_rims * steepest);
  record.rim_root = static_cast<float>(1.0 / least_order);
}

} // namespace

std::vector<shader::LightRun> light_runs(const DiodeGroups &groups, const Promise &promise) {
  const std::size_t run_diodes = std::size_t{groups.blocks_per_run} * shader::diodes_per_block;
  const double rounding = groups.precise_diodes.empty() ? 0x1p-24 : 0x1p-45;
  std::vector<shader::LightRun> result;
  for (const DiodeRun &run : groups.runs) {
    double intensity = 0.0, diagrams = 0.0; // relative; times what the diagrams are off by
    glm::dvec4 detours(0.0);
    for (std::size_t i = run.first; i < run.first + run_diodes; ++i) {
      intensity += static_cast<double>(groups.diodes[i].intensity);
      detours += glm::dvec4(groups.diodes[i].position);
      diagrams += static_cast<double>(groups.diodes[i].intensity) * groups.places[i].diagram_error;
    }
    const DoublePair4 reference(run.reference_m, 0.0);
    const DoublePair phase_turns(run.phase_turns);
    const double size_m = glm::length(run.reference_m) + run.reach.radius_m;
    shader::LightRun record{};
    record.reference_hi = reference.hi;
    record.reference_lo = reference.lo;
    record.phase_turns = {phase_turns.hi, phase_turns.lo};
    record.radius_m = static_cast<float>(run.reach.radius_m);
    record.intensity = static_cast<float>(intensity);
    record.detours = detours;
    record.heights = static_cast<float>(promise.terms_per_weight_error * height_rounding * rounding * size_m);
    record.diagrams = static_cast<float>(promise.terms_per_weight_error * diagrams);
    set_rims(groups, run.first, run.first + run_diodes, promise, record);
    if (groups.power_sums.powers > 0)
      std::ranges::copy(groups.power_sums.tables[result.size()], record.moments_of_powers);
    result.push_back(record);
  }
  return result;
}

namespace {

vulkan::Buffer upload_runs(const vulkan::Device &device, const DiodeGroups &groups,
                           const std::optional<Promise> &promise) {
  const std::vector<shader::LightRun> runs = light_runs(groups, promise.value_or(Promise{}));
  return vulkan::upload(device, std::as_bytes(std::span(runs)));
}

} // namespace

AccumulatePass::AccumulatePass(const vulkan::Device &device, const DiodeGroups &groups, const SumModel &model,
                               const Signal &signal, const SimulatorOptions &options, const Scope &scope)
    : plain_(scope.plain), runs_(groups.runs), light_runs_(upload_runs(device, groups, scope.promise)),
      blocks_per_run_(groups.blocks_per_run), bundles_per_run_(bundles_per_run(groups)),
      dispatches_(signal.by_moments ? 1 : signal.frequencies()), planes_(signal.planes),
      tones_(upload_tones(device, signal)), diodes_(upload_diodes(device, groups, scope)),
      diode_bytes_(diodes_.bytes() / groups.diodes.size()),
      diagrams_(vulkan::upload(device, std::as_bytes(std::span(groups.diagrams)))),
      first_(make_pipeline(device, groups, model, signal, options, scope, true)) {
  if (runs_.size() > 1 && !plain_)
    later_ = make_pipeline(device, groups, model, signal, options, scope, false);
}

std::uint64_t AccumulatePass::interactions_per_run(const shader::Strip &strip) const {
  return std::uint64_t{sample_count(strip)} * blocks_per_run_ * shader::diodes_per_block * dispatches_;
}

void AccumulatePass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                            const StripBuffers &buffers, const SceneBuffers &scene, const LitWindow &window,
                            std::uint32_t first, std::uint32_t last, const vulkan::Buffer *list) const {
  const std::uint32_t plane = sample_count(strip);
  for (std::uint32_t run = first; run < last; ++run) {
    if (run > first)
      vulkan::compute_barrier(commands);
    if (plain_) {
      record_plain(commands, strip, buffers, scene, run);
      continue;
    }
    const vk::DeviceSize bundle = vk::DeviceSize{run - window.first_run} * bundles_per_run_;
    for (std::uint32_t d = 0; d < dispatches_; ++d) {
      const shader::AccumulateConstants constants{
          words(buffers.position.address()),
          words(buffers.surface.address()),
          words(buffers.backscatter.address()),
          words(buffers.sum.address() + vk::DeviceSize{d} * planes_ * plane * sizeof(shader::vec4)),
          words(light_runs_.address() + run * sizeof(shader::LightRun)),
          words(diodes_.address() + runs_[run].first * diode_bytes_),
          words(tones_.address() + d * sizeof(shader::Tone)),
          words(diagrams_.address()),
          words(buffers.reached.address() + bundle * plane * sizeof(std::uint32_t)),
          words(buffers.terms.address()),
          address_of(list),
          blocks_per_run_,
          plane,
          strip.padded_pixels,
          d == 0 ? 1u : 0u};
      dispatch_listed(run == 0 ? first_ : later_, commands, constants, plane, list, of_samples);
    }
  }
}

void AccumulatePass::record_plain(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                                  const StripBuffers &buffers, const SceneBuffers &scene,
                                  std::uint32_t run) const {
  const std::uint32_t plane = sample_count(strip);
  const shader::PlainSumConstants constants{plain_->of(strip),
                                            plain_->chip(),
                                            words(buffers.tags.address()),
                                            words(scene.planes.address()),
                                            words(buffers.sum.address()),
                                            words(light_runs_.address() + run * sizeof(shader::LightRun)),
                                            words(diodes_.address() + runs_[run].first * diode_bytes_),
                                            words(tones_.address()),
                                            words(diagrams_.address()),
                                            blocks_per_run_,
                                            plane,
                                            strip.columns * strip.rows * strip.samples * strip.samples,
                                            run == 0 ? 1u : 0u};
  first_.dispatch(commands, constants, plane, shader::workgroup_size);
}

} // namespace pmdsim
