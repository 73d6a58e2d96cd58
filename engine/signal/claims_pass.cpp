#include "engine/signal/claims_pass.h"

#include "engine/sampling/pixel_lists.h"
#include "engine/vulkan/commands.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <memory>
#include <span>

namespace pmdsim {
namespace {

// Like claims.comp.
class HostClaims {
public:
  HostClaims(const PassSetup &on, const HeldErrors &errors, const vulkan::Buffer *later)
      : errors_(errors), violations_(on.buffers.violations), later_(later),
        tones_(on.modulation.frequencies()), reports_kept_(on.modulation.reports_kept) {}

  void settle(const shader::Strip &strip) const {
    // Bits of floats compare as the floats do, where these are not negative, and all others are below 0.
    glm::ivec2 kept(0), least(0);
    for (std::uint32_t tone = 0; tone < tones_; ++tone)
      for (const glm::ivec2 &errors : errors_of(strip, tone)) {
        kept = glm::max(kept, errors);
        least = glm::min(least, errors);
      }
    auto &words = *violations_.mapped_as<shader::BudgetViolations>();
    if (reports_kept_) {
      words.kept_m = std::max(words.kept_m, std::bit_cast<float>(kept.x));
      words.kept_amplitude = std::max(words.kept_amplitude, std::bit_cast<float>(kept.y));
    }
    for (std::uint32_t pixel = 0; least.x < 0 && pixel < strip.columns * strip.rows; ++pixel)
      settle_pixel(strip, pixel, words);
  }

private:
  std::span<const glm::ivec2> errors_of(const shader::Strip &strip, std::uint32_t tone) const {
    const auto *errors =
        reinterpret_cast<const glm::ivec2 *>(errors_.in.mapped().data() + errors_.offset(strip));
    return {errors + std::size_t{tone} * errors_.plane(strip), std::size_t{strip.columns} * strip.rows};
  }

  void settle_pixel(const shader::Strip &strip, std::uint32_t pixel, shader::BudgetViolations &words) const {
    bool passes = false;
    for (std::uint32_t tone = 0; tone < tones_; ++tone) {
      const glm::ivec2 &errors = errors_of(strip, tone)[pixel];
      if (errors.x >= 0)
        continue;
      passes = true;
      if (later_)
        continue;
      ++words.returns;
      words.worst_m = std::max(words.worst_m, -std::bit_cast<float>(errors.x));
      words.amplitude = std::max(words.amplitude, -std::bit_cast<float>(errors.y));
    }
    if (later_ && passes) {
      auto &list = *later_->mapped_as<shader::PixelList>();
      reinterpret_cast<std::uint32_t *>(&list + 1)[list.count++] = pixel;
    }
  }

  HeldErrors errors_;
  const vulkan::Buffer &violations_;
  const vulkan::Buffer *later_;
  std::uint32_t tones_;
  bool reports_kept_;
};

// lavapipe takes its time for atomics and gathers; the host reads the same memory at once.
Pass host_claims_pass(const PassSetup &on, const HeldErrors &errors, const vulkan::Buffer *later) {
  return {.name = "accumulate",
          .reads = errors.resource,
          .writes = later ? pixel_lists : no_resource,
          .record = [](const Recording &at) { vulkan::host_barrier(at.commands); },
          .store = [claims = HostClaims(on, errors, later)](const Recording &at,
                                                            Measurement &) { claims.settle(at.of_strip()); }};
}

bool is_shared_with_host(const PassSetup &on, const HeldErrors &errors, const vulkan::Buffer *later) {
  return on.device.is_cpu() && on.options.allowed.host_sweep && errors.in.is_mapped() &&
         on.buffers.violations.is_mapped() && (!later || later->is_mapped());
}

} // namespace

HeldErrors held_errors(const StripBuffers &buffers, HeldErrors::By by) {
  if (by == HeldErrors::By::direct_pixels)
    return {buffers.sum, sums, by, buffers.terms_of_sample};
  return {buffers.terms, terms, by, buffers.terms_of_sample};
}

Pass claims_pass(const PassSetup &on, const HeldErrors &errors, const vulkan::Buffer *later) {
  if (is_shared_with_host(on, errors, later))
    return host_claims_pass(on, errors, later);
  const auto pipeline = std::make_shared<const vulkan::ComputePipeline>(
      on.device, vulkan::shader_module(on.device, SamplePrecision::automatic, "claims"),
      sizeof(shader::ClaimsConstants),
      vulkan::Specialization{{shader::constant_passes_on, later != nullptr},
                             {shader::constant_reports_kept, on.modulation.reports_kept}});
  return {.name = "accumulate",
          .reads = errors.resource,
          .writes = later ? pixel_lists : no_resource,
          .record = [=, &buffers = on.buffers, tones = on.modulation.frequencies()](const Recording &at) {
            const shader::Strip &strip = at.of_strip();
            const std::uint32_t pixels = strip.columns * strip.rows;
            const shader::ClaimsConstants constants{errors.in.words(errors.offset(strip)),
                                                    buffers.violations.words(),
                                                    address_of(later),
                                                    pixels,
                                                    errors.plane(strip),
                                                    tones,
                                                    0};
            const std::uint32_t invocations =
                (pixels + shader::claims_per_invocation - 1) / shader::claims_per_invocation;
            pipeline->dispatch(at.commands, constants, padded(invocations), shader::workgroup_size);
          }};
}

} // namespace pmdsim
