#include "engine/signal/host/host_pixels.h"

#include "engine/light/host/strip_sums.h"
#include "engine/light/point_polynomials.h"
#include "engine/model/channels.h"
#include "engine/model/instruction_sets.h"
#include "engine/signal/channel_layout.h"
#include "engine/signal/direct_pixels.h"
#include "engine/signal/host/pixel_loops.h"
#include "engine/vulkan/commands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <numbers>
#include <span>
#include <stdexcept>

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::PixelLoops, pixel_loops)

namespace pmdsim {
namespace {

// The loops store these in pairs.
static_assert(row_of(&Return::amplitude).slot.index == 0 && row_of(&Return::phase_rad).slot.index == 1);
static_assert(most_pixel_frequencies == most_direct_frequencies);
static_assert(row_of(&Return::distance_m).slot.index == 2 && row_of(&Measurement::range_m).slot.index == 3);

class PixelsOnHost {
public:
  PixelsOnHost(const PassSetup &on, const SourceGroups &groups, const SumScope &scope);

  void make(const shader::Strip &strip) const;

private:
  void report(const PixelClaims &claims) const;
  void add_field(const PassSetup &on, const SourceGroups &groups, const InterpolatedField &field);
  void add_coefficients(const SourceGroups &groups, const SumModel &model, const RunForm &form);

  const StripBuffers &buffers_;
  StripSums sums_;
  std::vector<shader::LightRun> runs_;
  std::vector<shader::PointPolynomials> heads_; // beside the runs, where they are summed beforehand
  std::vector<std::vector<float>> coefficients_;
  std::vector<RunForm> forms_;
  std::vector<shader::Tone> tones_;
  std::vector<shader::Frequency> frequencies_; // the last one of the mean light where it is kept
  std::uint32_t frequency_count_;              // that have phases
  std::vector<shader::LightRun> field_runs_;   // these and what follows: where the field is interpolated
  std::vector<RunForm> field_forms_;
  std::vector<shader::Frequency> field_frequencies_;
  std::optional<float> backscatter_;
  bool vignetting_, lit_, holds_, keeps_bounds_, keeps_rests_, reports_kept_, complex_returns_;
  const vulkan::Buffer *later_;
  std::uint32_t first_tap_, bound_, rests_;
  std::vector<std::array<float, 2>> tap_phasors_; // of those that are kept
  PixelLoops loops_;
};

std::vector<std::array<float, 2>> tap_phasors(std::uint32_t taps) {
  std::vector<std::array<float, 2>> phasors;
  for (std::uint32_t k = 0; k < taps; ++k) {
    const double angle_rad = 2.0 * std::numbers::pi * k / taps;
    phasors.push_back({static_cast<float>(std::cos(angle_rad)), static_cast<float>(std::sin(angle_rad))});
  }
  return phasors;
}

RunForm form_of(const PassSetup &on, const SourceGroups &groups, const SumScope &scope) {
  const std::uint32_t pattern = on.model.pattern;
  RunForm form{};
  form.powers = groups.polynomials.powers;
  form.moments = groups.moments;
  form.lambert = on.model.backscatter == shader::backscatter_lambert;
  form.cosines = exponent_of(pattern == shader::pattern_power ? on.model.order : 0.0);
  form.coplanar = groups.polynomials.coplanar;
  form.phased = groups.phased;
  form.diagrams = pattern == shader::pattern_axial || pattern == shader::pattern_any;
  form.beam_edges = has_beam_edges(on.model, scope.bound);
  form.beams = on.modulation.keeps_beams;
  form.tests_facing = scope.tests_facing;
  return form;
}

PixelsOnHost::PixelsOnHost(const PassSetup &on, const SourceGroups &groups, const SumScope &scope)
    : buffers_(on.buffers), sums_(on, groups, scope, true),
      runs_(light_runs(groups, scope.bound.value_or(ErrorBound{}), scope.beforehand)),
      tones_(on.modulation.all_tones()),
      frequencies_(
          frequency_records(on.modulation, groups.largest_intensity_w_sr, scope.bound, groups.diode_count)),
      frequency_count_(on.modulation.modulations()), backscatter_(on.scene.backscatter),
      vignetting_(on.sensor.vignetting == Vignetting::cos4), lit_(on.modulation.lit),
      holds_(holds_pixels(on.modulation)), keeps_bounds_(on.modulation.keeps_bounds),
      keeps_rests_(on.modulation.keeps_rests), reports_kept_(on.modulation.reports_kept),
      complex_returns_(on.modulation.complex_returns), later_(scope.later),
      first_tap_(row_of(&Return::taps).slot.index),
      bound_(ChannelLayout(on.modulation).number({row_of(&Return::error_bound_m)}) -
             frequencies_.front().first_channel),
      rests_(ChannelLayout(on.modulation).rest_channels(0) - frequencies_.front().first_channel),
      tap_phasors_(tap_phasors(on.modulation.keep_taps ? on.modulation.taps : 0)),
      loops_(widest_pixel_loops(on.options.host_vector_bits)) {
  if (frequency_count_ > most_pixel_frequencies || on.scene.paint.painted || !buffers_.channels.is_mapped())
    throw std::logic_error("these pixels are the device's");
  const RunForm form = form_of(on, groups, scope);
  if (scope.beforehand)
    add_coefficients(groups, on.model, form);
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    RunForm &of_run = forms_.emplace_back(form);
    of_run.run = &runs_[i];
    of_run.path_difference_m = static_cast<float>(groups.runs[i].reach.path_difference_m);
    if (!scope.beforehand)
      continue;
    of_run.beforehand = &heads_[i];
    of_run.coefficients = coefficients_[i].data();
    of_run.dimensions = groups.polynomials.point_dimensions;
  }
  if (scope.field)
    add_field(on, groups, *scope.field);
}

void PixelsOnHost::add_field(const PassSetup &on, const SourceGroups &groups,
                             const InterpolatedField &field) {
  field_runs_ = light_runs(groups, field.bound, false);
  field_forms_ = forms_;
  for (std::size_t i = 0; i < field_forms_.size(); ++i) {
    field_forms_[i].run = &field_runs_[i];
    field_forms_[i].powers = 0; // rounding grows as at the nodes, which tell
  }
  field_frequencies_ =
      frequency_records(on.modulation, groups.largest_intensity_w_sr, field.bound, groups.diode_count);
}

// The coefficients of a sum of powers in the order of Horner's rule: those of the highest powers first, of z,
// of y, of x.
void append_in_order(std::span<const float> of_degree, std::uint32_t degree, std::uint32_t dimensions,
                     std::vector<float> &to) {
  const std::size_t components = of_degree.size() / polynomial_terms(degree, dimensions);
  for (std::uint32_t l = dimensions == 3 ? degree + 1 : 1; l-- > 0;)
    for (std::uint32_t k = degree - l + 1; k-- > 0;)
      for (std::uint32_t j = degree - l - k + 1; j-- > 0;) {
        const auto term = of_degree.subspan(polynomial_place(j, k, l, dimensions) * components, components);
        to.insert(to.end(), term.begin(), term.end());
      }
}

void PixelsOnHost::add_coefficients(const SourceGroups &groups, const SumModel &model, const RunForm &form) {
  const std::uint32_t dimensions = groups.polynomials.point_dimensions;
  const std::size_t components = form.lambert ? dimensions + 1 : 1;
  const std::vector<float> words = point_polynomials(groups, model, dimensions);
  const std::size_t of_run = words.size() / groups.runs.size(), of_head = sizeof(heads_[0]) / sizeof(float);
  for (std::size_t run = 0; run < groups.runs.size(); ++run) {
    std::span<const float> left = std::span(words).subspan(run * of_run);
    std::memcpy(&heads_.emplace_back(), left.data(), sizeof(heads_[0]));
    left = left.subspan(of_head);
    coefficients_.emplace_back();
    for (std::uint32_t degree = 0; degree < form.powers; ++degree) {
      const std::size_t of_degree = polynomial_terms(degree, dimensions) * components;
      append_in_order(left.first(of_degree), degree, dimensions, coefficients_.back());
      left = left.subspan(of_degree);
    }
  }
}

void PixelsOnHost::make(const shader::Strip &strip) const {
  const LawSums sums = sums_.of(strip);
  auto *later = later_ ? later_->mapped_as<shader::PixelList>() : nullptr;
  const PixelWork work{.sums = sums,
                       .forms = forms_.data(),
                       .tones = tones_.data(),
                       .frequencies = frequencies_.data(),
                       .frequency_count = frequency_count_,
                       .mean = frequency_count_ < frequencies_.size() ? &frequencies_.back() : nullptr,
                       .backscatter = backscatter_ ? &*backscatter_ : nullptr,
                       .vignetting = vignetting_,
                       .lit = lit_ ? buffers_.lit.mapped_as<std::uint32_t>() : nullptr,
                       .channels = buffers_.channels.mapped_as<float>(),
                       .plane = sums.plane,
                       .holds = holds_,
                       .later = later ? reinterpret_cast<std::uint32_t *>(later + 1) : nullptr,
                       .later_count = later ? &later->count : nullptr,
                       .keeps_bounds = keeps_bounds_,
                       .keeps_rests = keeps_rests_,
                       .first_tap = first_tap_,
                       .bound = bound_,
                       .rests = rests_,
                       .complex_returns = complex_returns_,
                       .kept_taps = static_cast<std::uint32_t>(tap_phasors_.size()),
                       .tap_phasors = reinterpret_cast<const float(*)[2]>(tap_phasors_.data()),
                       .cells_across = sums_.cells_across(strip),
                       .field_forms = field_forms_.data(),
                       .field_frequencies = field_frequencies_.data()};
  std::mutex reporting;
  const auto make_with = [&](const auto &loop) {
    return [&, loop](std::uint32_t first, std::uint32_t last) {
      const PixelClaims claims = loop(work, first, last);
      const std::lock_guard lock(reporting);
      report(claims);
    };
  };
  if (sums_.has_field())
    return sums_.for_each_cell(strip, make_with(loops_.of_cells));
  sums_.for_each_part(sums, make_with(loops_.of_rows), make_with(loops_.of_blocks));
}

void PixelsOnHost::report(const PixelClaims &claims) const {
  if (!holds_)
    return;
  auto &words = *buffers_.violations.mapped_as<shader::BudgetViolations>();
  if (reports_kept_) {
    words.kept_m = std::max(words.kept_m, claims.kept_m);
    words.kept_amplitude = std::max(words.kept_amplitude, claims.kept_amplitude);
  }
  words.returns += claims.returns_beyond;
  words.worst_m = std::max(words.worst_m, claims.worst_m);
  words.amplitude = std::max(words.amplitude, claims.worst_amplitude);
}

} // namespace

Pass host_pixels_pass(const PassSetup &on, const SourceGroups &groups, const SumScope &scope) {
  const auto pixels = std::make_shared<const PixelsOnHost>(on, groups, scope);
  return {.name = "accumulate",
          .reads = ids | (scope.shadowed ? visibility_bits : no_resource) |
                   (on.modulation.lit ? visibility_counts : no_resource) |
                   (scope.blocks ? block_lists : no_resource),
          .writes = channels | (scope.later ? pixel_lists : no_resource),
          .record = [](const Recording &at) { vulkan::host_barrier(at.commands); },
          .store = [pixels](const Recording &at, Measurement &) { pixels->make(at.of_strip()); }};
}

} // namespace pmdsim
