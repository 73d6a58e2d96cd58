#include "engine/light/accumulate_pass.h"

#include "engine/light/point_polynomials.h"
#include "engine/light/radiation_laws.h"
#include "engine/model/exponent.h"
#include "engine/sampling/pixel_lists.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/float_pair.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>

namespace pmdsim {
namespace {

// The rounding of a diode's height over a surface: this often u, 2^-24 for float and 2^-45 for fp64, times
// the size of the light with its distance from the lens.
constexpr double height_rounding = 14.0;

std::string_view module_of(const Modulation &modulation, const SumScope &scope) {
  const bool precise = scope.precision == Precision::fp64;
  return scope.output              ? scope.output->module
         : scope.depth_records     ? "accumulate_depths"
         : modulation.by_moments() ? precise ? "accumulate_precise" : "accumulate"
         : precise                 ? "accumulate_per_diode_precise"
                                   : "accumulate_per_diode";
}

// Precise sums of pairs of floats would take minutes to compile as a straight line.
bool is_straight(const vulkan::Device &device, const SimulatorOptions &options, Precision precision) {
  const bool loops = precision == Precision::fp64 && !vulkan::uses_fp64(device, options.precision);
  return !loops &&
         (options.loop == DiodeLoop::automatic ? device.is_cpu() : options.loop == DiodeLoop::straight_line);
}

bool sums_equal_weights(const SourceGroups &groups, const SumScope &scope) {
  return groups.polynomials.equal_weights && !scope.shadowed && !scope.by_host;
}

// Sets the terms of a run's diodes `first` to `last` - 1 where their beams end (beam_edge_terms in
// shaders/light/sum.glsl).
void set_beam_edges(const SourceGroups &groups, std::size_t first, std::size_t last, const ErrorBound &bound,
                    shader::LightRun &record) {
  double steepest = 0.0, most = 0.0, least_power = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; ++i)
    if (const auto edge = beam_edge(groups.diodes[i])) {
      steepest = std::max(steepest, edge->steepness);
      least_power = std::min(least_power, edge->power);
      most = std::max(most, edge->steepness * std::exp2(-0.5 * (edge->power - 1.0))); // at 45 degrees
    }
  record.beam_edges = static_cast<float>(bound.terms_of_beam_edges * steepest);
  record.beam_edge_root = static_cast<float>(1.0 / least_power);
  record.beam_edge_most = static_cast<float>(bound.terms_of_beam_edges * most);
}

} // namespace

bool has_beam_edges(const SumModel &model, const std::optional<ErrorBound> &bound) {
  return bound && bound->terms_of_beam_edges > 0.0 && model.pattern != shader::pattern_isotropic &&
         model.pattern != shader::pattern_axial;
}

vulkan::Buffer upload_diodes(const vulkan::Device &device, const SourceGroups &groups,
                             const SumScope &scope) {
  if (scope.precision == Precision::fp64)
    return vulkan::upload(device, groups.precise_diodes);
  if (!sums_equal_weights(groups, scope))
    return vulkan::upload(device, groups.diodes);
  std::vector<shader::vec4> positions(groups.diodes.size());
  std::ranges::transform(groups.diodes, positions.begin(), &shader::GroupSource::position);
  return vulkan::upload(device, positions);
}

vulkan::Specialization sum_constants(const PassSetup &on, const SourceGroups &groups, const SumScope &scope) {
  const Exponent order = exponent_of(on.model.order);
  return {
      {shader::constant_straight, !scope.looped && is_straight(on.device, on.options, scope.precision)},
      {shader::constant_blocks_per_run, groups.blocks_per_run},
      {shader::constant_moments, groups.moments},
      {shader::constant_powers, groups.polynomials.powers},
      {shader::constant_equal_weights, sums_equal_weights(groups, scope)},
      {shader::constant_coplanar, groups.polynomials.coplanar},
      {shader::constant_point_dimensions, scope.beforehand ? groups.polynomials.point_dimensions : 0},
      {shader::constant_summed_by_host, scope.by_host},
      {shader::constant_backscatter_model, on.model.backscatter},
      {shader::constant_pattern_model, on.model.pattern},
      {shader::constant_cosine_order, order.whole},
      {shader::constant_cosine_fraction, std::bit_cast<std::uint32_t>(order.rest)},
      {shader::constant_phased, groups.phased},
      {shader::constant_keeps_mean, on.modulation.keeps_mean},
      {shader::constant_beam_edges, has_beam_edges(on.model, scope.bound)},
      {shader::constant_beams, on.modulation.keeps_beams},
      {shader::constant_shadowed, scope.shadowed},
      {shader::constant_tones, on.modulation.tones * on.modulation.frequencies()},
      {shader::constant_taps, on.modulation.taps},
      {shader::constant_listed, scope.list != nullptr},
      {shader::constant_bits_by_row, on.buffers.id_bytes == sizeof(shader::uvec4) && on.sensor.samples > 1},
      {shader::constant_keeps_terms, on.modulation.keeps_terms}};
}

std::vector<shader::LightRun> light_runs(const SourceGroups &groups, const ErrorBound &bound,
                                         bool beforehand) {
  const std::size_t run_diodes = std::size_t{groups.blocks_per_run} * shader::diodes_per_block;
  const double rounding = groups.precise_diodes.empty() ? 0x1p-24 : 0x1p-45;
  std::vector<shader::LightRun> result;
  for (const SourceRun &run : groups.runs) {
    double intensity = 0.0, brightest = 0.0, diagrams = 0.0; // relative; times the laws' largest J, errors
    glm::dvec4 detours(0.0);
    for (std::size_t i = run.first; i < run.first + run_diodes; ++i) {
      intensity += static_cast<double>(groups.diodes[i].intensity);
      brightest += static_cast<double>(groups.diodes[i].intensity) * groups.positions[i].brightest;
      detours += glm::dvec4(groups.diodes[i].position);
      diagrams += static_cast<double>(groups.diodes[i].intensity) * groups.positions[i].law_error;
    }
    const DoublePair4 reference(run.reference_m, 0.0);
    const double size_m = glm::length(run.reference_m) + run.reach.radius_m;
    shader::LightRun record{};
    record.reference_hi = reference.hi;
    record.reference_lo = reference.lo;
    record.phase_turns = float_pair(run.phase_turns);
    record.mean_over_modulated = static_cast<float>(1.0 / run.modulation_depth);
    record.radius_m = static_cast<float>(run.reach.radius_m);
    record.intensity = static_cast<float>(intensity);
    record.brightest = static_cast<float>(brightest);
    record.detours = detours;
    // Summed beforehand, heights of places to either side of the reference cancel.
    const double apart_m =
        beforehand ? beforehand_error_u(groups.polynomials.powers) * run.reach.radius_m : 0.0;
    record.heights =
        static_cast<float>(bound.terms_per_weight_error * rounding * (height_rounding * size_m + apart_m));
    record.diagrams = static_cast<float>(bound.terms_per_weight_error * diagrams);
    set_beam_edges(groups, run.first, run.first + run_diodes, bound, record);
    const double squared = bound.terms_per_weight_error * bound.terms_per_weight_error;
    record.beams = static_cast<float>(squared * bound.beams.square);
    record.beams_per_log = static_cast<float>(squared * bound.beams.square_per_log);
    if (groups.polynomials.powers > 0)
      std::ranges::copy(groups.polynomials.tables[result.size()], record.moments_of_powers);
    result.push_back(record);
  }
  return result;
}

namespace {

// The pass on the device.
class Sum {
public:
  Sum(const PassSetup &on, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
      const SumScope &scope);

  void record(const Recording &at) const;
  // Samples times diodes of one run over `strip`, padding included.
  std::uint64_t interactions_per_run(const shader::Strip &strip) const {
    return std::uint64_t{sample_count(strip)} * blocks_per_run_ * shader::diodes_per_block * dispatches_;
  }

private:
  vulkan::ComputePipeline make_pipeline(const PassSetup &on, const SourceGroups &groups,
                                        const SumScope &scope, bool first) const;
  void record_run(const Recording &at, std::uint32_t run) const;
  void record_run_of_depths(const Recording &at, std::uint32_t run) const;

  const StripBuffers &buffers_;
  const SceneBuffers &scene_;
  std::vector<SourceWindow> windows_;
  const vulkan::Buffer *list_;
  std::optional<ChipGrid> depth_records_;
  std::optional<SampleBlocks> blocks_;
  std::shared_ptr<const SumOutput> output_;
  std::vector<SourceRun> runs_;
  vulkan::Buffer light_runs_; // shader::LightRun of each
  std::uint32_t blocks_per_run_, bundles_per_run_;
  std::uint32_t dispatches_; // a run: one by moments, else one for each frequency
  std::uint32_t planes_;     // of the sum, of each frequency
  bool by_host_;
  std::uint32_t moments_; // of each run
  vulkan::Buffer tones_, diodes_, diagrams_;
  vk::DeviceSize run_bytes_;      // of the diodes of each run
  vulkan::ComputePipeline first_; // the first of a frame's runs; for depth records all
  vulkan::ComputePipeline later_; // all the others; empty where there are none
};

// The data that a run's diodes are summed from.
vulkan::Buffer upload_sum(const PassSetup &on, const SourceGroups &groups, const SumScope &scope) {
  return scope.beforehand ? vulkan::upload(on.device, point_polynomials(groups, on.model,
                                                                        groups.polynomials.point_dimensions))
                          : upload_diodes(on.device, groups, scope);
}

Sum::Sum(const PassSetup &on, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
         const SumScope &scope)
    : buffers_(on.buffers), scene_(on.scene), windows_(windows), list_(scope.list),
      depth_records_(scope.depth_records), blocks_(scope.blocks), output_(scope.output), runs_(groups.runs),
      light_runs_(vulkan::upload(on.device,
                                 light_runs(groups, scope.bound.value_or(ErrorBound{}), scope.beforehand))),
      blocks_per_run_(groups.blocks_per_run), bundles_per_run_(bundles_per_run(groups)),
      dispatches_(on.modulation.by_moments() ? 1 : on.modulation.frequencies()),
      planes_(on.modulation.planes), by_host_(scope.by_host), moments_(groups.moments),
      tones_(vulkan::upload(on.device, on.modulation.all_tones())), diodes_(upload_sum(on, groups, scope)),
      diagrams_(vulkan::upload(on.device, groups.diagrams)), run_bytes_(diodes_.bytes() / groups.runs.size()),
      first_(make_pipeline(on, groups, scope, true)) {
  if (runs_.size() > 1 && !depth_records_)
    later_ = make_pipeline(on, groups, scope, false);
}

vulkan::ComputePipeline Sum::make_pipeline(const PassSetup &on, const SourceGroups &groups,
                                           const SumScope &scope, bool first) const {
  vulkan::Specialization constants = sum_constants(on, groups, scope);
  constants.set(shader::constant_is_first, first).set(shader::constant_is_only, runs_.size() == 1);
  if (scope.output)
    constants.merge(scope.output->constants);
  if (depth_records_)
    constants.set(shader::constant_general_chip, !depth_records_->is_nominal())
        .set(shader::constant_block_list, blocks_ ? blocks_->kind : shader::no_blocks);
  return {on.device, vulkan::shader_module(on.device, on.options.precision, module_of(on.modulation, scope)),
          depth_records_ ? sizeof(shader::DepthSumConstants) : sizeof(shader::AccumulateConstants),
          constants};
}

void Sum::record(const Recording &at) const {
  for (std::uint32_t run = at.parts.first; run < at.parts.last; ++run) {
    if (run > at.parts.first)
      vulkan::compute_barrier(at.commands);
    if (depth_records_)
      record_run_of_depths(at, run);
    else
      record_run(at, run);
  }
}

void Sum::record_run(const Recording &at, std::uint32_t run) const {
  const std::uint32_t plane = sample_count(at.of_strip());
  const vk::DeviceSize bundle = vk::DeviceSize{run - windows_[at.window].first_run} * bundles_per_run_;
  for (std::uint32_t d = 0; d < dispatches_; ++d) {
    const shader::AccumulateConstants constants{
        buffers_.position.words(),
        buffers_.surface.words(),
        buffers_.backscatter.words(),
        buffers_.sum.words(vk::DeviceSize{d} * planes_ * plane * sizeof(shader::vec4)),
        light_runs_.words(run * sizeof(shader::LightRun)),
        diodes_.words(run * run_bytes_),
        tones_.words(d * sizeof(shader::Tone)),
        diagrams_.words(),
        buffers_.visibility.words(bundle * plane * sizeof(std::uint32_t)),
        buffers_.terms.words(),
        address_of(list_),
        blocks_per_run_,
        plane,
        at.of_strip().padded_pixels,
        d == 0 ? 1u : 0u,
        at.of_strip().columns,
        at.of_strip().samples};
    dispatch_listed(run == 0 ? first_ : later_, at.commands, constants, plane, list_, of_samples);
  }
}

void Sum::record_run_of_depths(const Recording &at, std::uint32_t run) const {
  const shader::Strip &strip = at.of_strip();
  const std::uint32_t plane = sample_count(strip);
  const shader::DepthSumConstants constants{
      depth_records_->of(strip),
      depth_records_->chip(),
      buffers_.ids.words(),
      scene_.planes.words(),
      output_ ? output_->record.words() : buffers_.sum.words(),
      light_runs_.words(run * sizeof(shader::LightRun)),
      by_host_ ? buffers_.run_moments.words(vk::DeviceSize{run} * (moments_ + 1) * plane * sizeof(float))
               : diodes_.words(run * run_bytes_),
      tones_.words(),
      diagrams_.words(),
      blocks_per_run_,
      plane,
      strip.columns * strip.rows * strip.samples * strip.samples,
      run == 0 ? 1u : 0u,
      buffers_.visibility.words(),
      blocks_ ? blocks_->list->words() : shader::uvec2(0)};
  if (blocks_)
    first_.dispatch_indirect(at.commands, constants, *blocks_->list, 0);
  else
    first_.dispatch(at.commands, constants, plane, shader::workgroup_size);
}

} // namespace

Pass accumulate_pass(const PassSetup &on, const SourceGroups &groups,
                     const std::vector<SourceWindow> &windows, const SumScope &scope) {
  const auto sum = std::make_shared<const Sum>(on, groups, windows, scope);
  return {.name = "accumulate",
          .reads = (scope.depth_records ? ids : points) | (scope.shadowed ? visibility_bits : no_resource) |
                   (scope.by_host ? run_moments : no_resource) | (scope.list ? pixel_lists : no_resource) |
                   (scope.blocks ? block_lists : no_resource) |
                   (scope.output && on.modulation.lit ? visibility_counts : no_resource),
          .writes = scope.output ? channels | sums : sums | terms,
          .record = [sum](const Recording &at) { sum->record(at); },
          .parts =
              [windows](std::size_t of) {
                return Parts{windows[of].first_run, windows[of].last_run};
              },
          .all_parts = static_cast<std::uint32_t>(groups.runs.size()),
          .interactions = [sum](const shader::Strip &strip) { return sum->interactions_per_run(strip); },
          .prepare_warm_up = scope.blocks ? fill_with_one(*scope.blocks) : fill_with_one(scope.list)};
}

} // namespace pmdsim
