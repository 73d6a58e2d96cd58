#include "engine/light/accumulate_pass.h"

#include "engine/light/radiation_laws.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/float_pair.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

// What rounding does to a diode's height over a surface: this often u, 2^-24 of float and 2^-45 of fp64,
// times the size of the light with its distance from the lens.
constexpr double height_rounding = 14.0;

std::string_view module_of(const Signal &signal, const AccumulatePass::Scope &scope) {
  if (scope.plain)
    return "accumulate_plain";
  if (!signal.by_moments)
    return "accumulate_per_diode";
  return scope.precision == Precision::fp64 ? "accumulate_precise" : "accumulate";
}

// Precise sums of pairs of floats would take minutes to compile as a straight line.
bool is_straight(const vulkan::Device &device, const SimulatorOptions &options, Precision precision) {
  const bool loops = precision == Precision::fp64 && !vulkan::uses_fp64(device, options.precision);
  return !loops &&
         (options.loop == DiodeLoop::automatic ? device.is_cpu() : options.loop == DiodeLoop::straight_line);
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

vulkan::Specialization sum_constants(const vulkan::Device &device, const SimulatorOptions &options,
                                     const DiodeGroups &groups, const SumModel &model, const Signal &signal,
                                     const AccumulatePass::Scope &scope) {
  return {{shader::constant_straight, is_straight(device, options, scope.precision)},
          {shader::constant_blocks_per_run, groups.blocks_per_run},
          {shader::constant_moments, groups.moments},
          {shader::constant_powers, groups.power_sums.powers},
          {shader::constant_alike, sums_alike(groups, scope)},
          {shader::constant_planar, groups.power_sums.planar},
          {shader::constant_backscatter_model, model.backscatter},
          {shader::constant_pattern_model, model.pattern},
          {shader::constant_cosine_order, model.order},
          {shader::constant_phased, groups.phased},
          {shader::constant_shadowed, scope.shadowed},
          {shader::constant_tones, signal.tones * signal.frequencies()},
          {shader::constant_waveform, signal.waveform},
          {shader::constant_taps, signal.taps},
          {shader::constant_listed, scope.listed},
          {shader::constant_promised, signal.promised}};
}

namespace {

vulkan::ComputePipeline make_pipeline(const vulkan::Device &device, const DiodeGroups &groups,
                                      const SumModel &model, const Signal &signal,
                                      const SimulatorOptions &options, const AccumulatePass::Scope &scope,
                                      bool first) {
  vulkan::Specialization constants = sum_constants(device, options, groups, model, signal, scope);
  constants.set(shader::constant_is_first, first);
  if (scope.plain)
    constants.set(shader::constant_is_only, groups.runs.size() == 1)
        .set(shader::constant_general_chip, !scope.plain->is_nominal());
  const vulkan::ShaderModule &module =
      vulkan::shader_module(device, options.precision, module_of(signal, scope));
  return {device, module,
          scope.plain ? sizeof(shader::PlainSumConstants) : sizeof(shader::AccumulateConstants), constants};
}

// What a run's diodes at `first` to `last` - 1 come to where their beams end (rim_terms in
// shaders/light/sum.glsl).
void set_rims(const DiodeGroups &groups, std::size_t first, std::size_t last, const Promise &promise,
              shader::LightRun &record) {
  double steepest = 0.0, least_power = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; ++i)
    if (const auto rim = beam_rim(groups.diodes[i])) {
      steepest = std::max(steepest, rim->steepness);
      least_power = std::min(least_power, rim->power);
    }
  record.rims = static_cast<float>(promise.terms_of_rims * steepest);
  record.rim_root = static_cast<float>(1.0 / least_power);
}

} // namespace

std::vector<shader::LightRun> light_runs(const DiodeGroups &groups, const Promise &promise) {
  const std::size_t run_diodes = std::size_t{groups.blocks_per_run} * shader::diodes_per_block;
  const double rounding = groups.precise_diodes.empty() ? 0x1p-24 : 0x1p-45;
  std::vector<shader::LightRun> result;
  for (const DiodeRun &run : groups.runs) {
    double intensity = 0.0, diagrams = 0.0; // relative; times what the laws are off by
    glm::dvec4 detours(0.0);
    for (std::size_t i = run.first; i < run.first + run_diodes; ++i) {
      intensity += static_cast<double>(groups.diodes[i].intensity);
      detours += glm::dvec4(groups.diodes[i].position);
      diagrams += static_cast<double>(groups.diodes[i].intensity) * groups.places[i].law_error;
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
          buffers.position.words(),
          buffers.surface.words(),
          buffers.backscatter.words(),
          buffers.sum.words(vk::DeviceSize{d} * planes_ * plane * sizeof(shader::vec4)),
          light_runs_.words(run * sizeof(shader::LightRun)),
          diodes_.words(runs_[run].first * diode_bytes_),
          tones_.words(d * sizeof(shader::Tone)),
          diagrams_.words(),
          buffers.reached.words(bundle * plane * sizeof(std::uint32_t)),
          buffers.terms.words(),
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
                                            buffers.tags.words(),
                                            scene.planes.words(),
                                            buffers.sum.words(),
                                            light_runs_.words(run * sizeof(shader::LightRun)),
                                            diodes_.words(runs_[run].first * diode_bytes_),
                                            tones_.words(),
                                            diagrams_.words(),
                                            blocks_per_run_,
                                            plane,
                                            strip.columns * strip.rows * strip.samples * strip.samples,
                                            run == 0 ? 1u : 0u};
  first_.dispatch(commands, constants, plane, shader::workgroup_size);
}

} // namespace pmdsim
