#include "engine/signal/channel_layout.h"

#include "engine/model/float_below.h"
#include "engine/vulkan/float_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pmdsim {
namespace {

using Area = DeviceSlot::Area;

constexpr std::uint32_t pair_of_rests = 2;

constexpr std::uint32_t whole_pairs(std::uint32_t channels) { return (channels + 1) / 2 * 2; }

// An area's channels, without taps, whose number varies.
constexpr std::uint32_t channels_in(Area area) {
  std::uint32_t end = 0;
  for (const ChannelRow &row : channel_rows)
    if (row.slot.area == area && !is_of_taps(row))
      end = std::max(end, row.slot.index + 1);
  return whole_pairs(end);
}

constexpr bool slots_differ() {
  for (const ChannelRow &a : channel_rows)
    for (const ChannelRow &b : channel_rows)
      if (&a != &b && a.slot.area == b.slot.area && a.slot.index == b.slot.index)
        return false;
  return true;
}

static_assert(slots_differ());
static_assert(row_of(&Return::taps).slot.index == channels_in(Area::frequency), "taps come last");

shader::Frequency record_of(double modulation_hz, double largest_intensity_w_sr,
                            std::uint32_t first_channel) {
  const double ambiguity_m = speed_of_light_m_s / (2.0 * modulation_hz);
  shader::Frequency record{};
  record.turns_per_m = float_pair(1.0 / ambiguity_m);
  record.ambiguity_m = float_pair(ambiguity_m);
  record.below = {largest_float_below(2.0 * std::numbers::pi), largest_float_below(ambiguity_m)};
  record.amplitude_scale = static_cast<float>(largest_intensity_w_sr);
  record.first_channel = first_channel;
  return record;
}

// Nothing is asked of it: it has no distance, and of its amplitude the electrons' noise leaves few digits.
shader::Frequency mean_record(const ChannelLayout &layout, double largest_intensity_w_sr) {
  shader::Frequency record{};
  record.amplitude_scale = static_cast<float>(largest_intensity_w_sr);
  record.first_channel = layout.mean_channel();
  record.limit_m = record.amplitude_limit = std::numeric_limits<float>::max();
  return record;
}

} // namespace

ChannelLayout::ChannelLayout(const Modulation &modulation)
    : frequencies(modulation.modulations()), taps(modulation.keep_taps ? modulation.taps : 0),
      lit(modulation.lit), bounds(modulation.keeps_bounds), rests(modulation.keeps_rests),
      mean(modulation.keeps_mean) {}

std::uint32_t ChannelLayout::first_channel(std::uint32_t frequency) const {
  const std::uint32_t of_frequency = whole_pairs(channels_in(Area::frequency) + taps) +
                                     (bounds ? channels_in(Area::bound) : 0) + (rests ? pair_of_rests : 0);
  return channels_in(Area::truth) + frequency * of_frequency;
}

std::uint32_t ChannelLayout::rest_channels(std::uint32_t frequency) const {
  return first_channel(frequency + 1) - pair_of_rests;
}

std::uint32_t ChannelLayout::lit_channel() const { return first_channel(frequencies); }

std::uint32_t ChannelLayout::mean_channel() const {
  return lit_channel() + (lit ? channels_in(Area::shadow) : 0);
}

std::uint32_t ChannelLayout::channels() const {
  return mean_channel() + (mean ? channels_in(Area::mean) : 0);
}

bool ChannelLayout::holds(const ChannelRow &row) const {
  switch (row.slot.area) {
  case Area::truth:
    return true;
  case Area::frequency:
    return !is_of_taps(row) || taps > 0;
  case Area::shadow:
    return lit;
  case Area::bound:
    return bounds;
  case Area::mean:
    return mean;
  case Area::electrons:
  case Area::unwrapped:
  case Area::view:
  case Area::none:
    break;
  }
  return false;
}

std::uint32_t ChannelLayout::number(const ChannelIndex &of) const {
  const auto [area, index] = of.row.slot;
  const std::uint32_t of_frequency = first_channel(static_cast<std::uint32_t>(of.frequency));
  const std::uint32_t first = area == Area::frequency ? of_frequency
                              : area == Area::bound
                                  ? of_frequency + whole_pairs(channels_in(Area::frequency) + taps)
                              : area == Area::shadow ? lit_channel()
                              : area == Area::mean   ? mean_channel()
                                                     : 0;
  return first + index + static_cast<std::uint32_t>(of.tap);
}

std::vector<shader::Frequency> frequency_records(const Modulation &modulation, double largest_intensity_w_sr,
                                                 const std::optional<ErrorBound> &bound,
                                                 std::uint32_t diodes) {
  const ChannelLayout layout(modulation);
  std::vector<shader::Frequency> records;
  for (std::uint32_t f = 0; f < modulation.modulations(); ++f) {
    records.push_back(
        record_of(modulation.modulation_hz[f], largest_intensity_w_sr, layout.first_channel(f)));
    records.back().diodes = diodes;
    records.back().lit_channel = layout.lit_channel();
    if (!bound)
      continue;
    shader::Frequency &record = records.back();
    record.limit_m = static_cast<float>(bound->limit_m);
    record.fixed_m = static_cast<float>(bound->fixed_m);
    record.per_condition_m = static_cast<float>(bound->per_condition_m);
    const ErrorBound::AtOneRange nearest = bound->nearest();
    record.near_fixed_m = static_cast<float>(nearest.fixed_m);
    record.near_per_condition_m = static_cast<float>(nearest.per_condition_m);
    record.per_apart = static_cast<float>(nearest.per_apart);
    record.weight_error = static_cast<float>(bound->weight_error / weight_error_unit);
    record.per_weight_m = static_cast<float>(weight_error_unit * bound->per_weight_m);
    record.any_weight_m = static_cast<float>(std::min(weight_error_unit * bound->any_weight_m, 1e30));
    record.even_part = static_cast<float>(bound->even_part);
    record.near_even_part = static_cast<float>(nearest.even_part);
    record.near_per_weight_m = static_cast<float>(weight_error_unit * nearest.per_weight_m);
    record.per_weight = static_cast<float>(weight_error_unit * bound->amplitude_per_weight);
    record.amplitude_limit = static_cast<float>(bound->amplitude_limit);
    record.amplitude_fixed = static_cast<float>(bound->amplitude_fixed);
    record.amplitude_per_condition = static_cast<float>(bound->amplitude_per_condition);
  }
  if (modulation.keeps_mean) {
    shader::Frequency &record = records.emplace_back(mean_record(layout, largest_intensity_w_sr));
    record.diodes = diodes;
    record.lit_channel = layout.lit_channel();
  }
  return records;
}

} // namespace pmdsim
