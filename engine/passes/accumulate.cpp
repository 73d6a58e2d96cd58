#include "engine/passes/accumulate.h"

#include "engine/passes/double_pair.h"
#include "engine/passes/sample_precision.h"
#include "engine/vulkan/commands.h"
#include "spirv/accumulate_looped_double_float.h"
#include "spirv/accumulate_looped_fp64.h"
#include "spirv/accumulate_straight_double_float.h"
#include "spirv/accumulate_straight_fp64.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pmdsim {
namespace {

// Up to here a whole power is multiplied out; the general form is as exact and faster beyond.
constexpr double largest_whole_power = 8.0;

std::span<const std::uint32_t> accumulate_spirv(const vulkan::Device &device,
                                                const SimulatorOptions &options) {
  const bool straight =
      options.loop == DiodeLoop::automatic ? device.is_cpu() : options.loop == DiodeLoop::straight_line;
  return straight ? choose(device, options.precision, shader::accumulate_straight_fp64_spirv,
                           shader::accumulate_straight_double_float_spirv)
                  : choose(device, options.precision, shader::accumulate_looped_fp64_spirv,
                           shader::accumulate_looped_double_float_spirv);
}

vulkan::ComputePipeline make_pipeline(const vulkan::Device &device, const DiodeGroups &groups,
                                      const SumModel &model, const SimulatorOptions &options, bool first) {
  return {device,
          accumulate_spirv(device, options),
          sizeof(shader::AccumulateConstants),
          {groups.moments, model.backscatter, model.pattern, model.order, groups.blocks_per_run,
           first ? 1u : 0u}};
}

} // namespace

SumModel sum_model(const std::vector<Diode> &diodes, Backscatter backscatter, bool all_face_the_light) {
  SumModel model{shader::backscatter_lambert, shader::pattern_general, 0};
  if (backscatter == Backscatter::constant)
    model.backscatter = all_face_the_light ? shader::backscatter_flat : shader::backscatter_facing;
  const Pattern &first = diodes.front().pattern;
  const bool alike = std::ranges::all_of(diodes, [&](const Diode &diode) {
    return diode.pattern.kind == first.kind && diode.pattern.order == first.order;
  });
  if (alike && first.kind == Pattern::Kind::isotropic)
    model.pattern = shader::pattern_isotropic;
  else if (alike && first.order >= 1.0 && first.order <= largest_whole_power &&
           first.order == std::floor(first.order)) {
    model.pattern = shader::pattern_power;
    model.order = static_cast<std::uint32_t>(first.order);
  }
  return model;
}

AccumulatePass::AccumulatePass(const vulkan::Device &device, const DiodeGroups &groups, const SumModel &model,
                               double modulation_hz, const SimulatorOptions &options)
    : runs_(groups.runs), blocks_per_run_(groups.blocks_per_run), modulation_hz_(modulation_hz),
      diodes_(vulkan::upload(device, std::as_bytes(std::span(groups.diodes)))),
      first_(make_pipeline(device, groups, model, options, true)) {
  if (runs_.size() > 1)
    later_ = make_pipeline(device, groups, model, options, false);
}

std::uint64_t AccumulatePass::interactions_per_run(const shader::Strip &strip) const {
  return std::uint64_t{sample_count(strip)} * blocks_per_run_ * shader::diodes_per_block;
}

void AccumulatePass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                            const StripBuffers &buffers, std::uint32_t first, std::uint32_t last) const {
  const double per_wavelength = modulation_hz_ / speed_of_light_m_s;
  for (std::uint32_t run = first; run < last; ++run) {
    vulkan::compute_barrier(commands);
    const DoublePair4 reference(runs_[run].reference_m, per_wavelength);
    const shader::AccumulateConstants constants{
        words(buffers.position_hi.address()),
        words(buffers.position_lo.address()),
        words(buffers.surface.address()),
        words(buffers.backscatter.address()),
        words(buffers.sum.address()),
        words(diodes_.address() + runs_[run].first * sizeof(shader::GroupDiode)),
        reference.hi,
        reference.lo,
        static_cast<float>(2.0 * std::numbers::pi * per_wavelength),
        blocks_per_run_};
    (run == 0 ? first_ : later_).dispatch(commands, constants, sample_count(strip), shader::workgroup_size);
  }
}

} // namespace pmdsim
