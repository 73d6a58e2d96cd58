#include "engine/signal/frequency_records.h"

#include "engine/vulkan/float_pair.h"

#include <cmath>
#include <numbers>

namespace pmdsim {
namespace {

float largest_float_below(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) < value ? nearest : std::nextafter(nearest, 0.0f);
}

shader::Frequency record_of(double modulation_hz, double largest_intensity_w_sr,
                            std::uint32_t first_channel) {
  const double ambiguity_m = speed_of_light_m_s / (2.0 * modulation_hz);
  const DoublePair turns_per_m(1.0 / ambiguity_m), ambiguity(ambiguity_m);
  shader::Frequency record{};
  record.turns_per_m = {turns_per_m.hi, turns_per_m.lo};
  record.ambiguity_m = {ambiguity.hi, ambiguity.lo};
  record.below = {largest_float_below(2.0 * std::numbers::pi), largest_float_below(ambiguity_m)};
  record.amplitude_scale = static_cast<float>(largest_intensity_w_sr);
  record.first_channel = first_channel;
  return record;
}

} // namespace

std::vector<shader::Frequency> frequency_records(const Signal &signal, double largest_intensity_w_sr,
                                                 const std::optional<Promise> &promise) {
  std::vector<shader::Frequency> records;
  for (std::uint32_t f = 0; f < signal.frequencies(); ++f) {
    records.push_back(record_of(signal.modulation_hz[f], largest_intensity_w_sr, signal.first_channel(f)));
    if (!promise)
      continue;
    shader::Frequency &record = records.back();
    record.limit_m = static_cast<float>(promise->limit_m);
    record.fixed_m = static_cast<float>(promise->fixed_m);
    record.per_condition_m = static_cast<float>(promise->per_condition_m);
    record.amplitude_limit = static_cast<float>(promise->amplitude_limit);
    record.amplitude_fixed = static_cast<float>(promise->amplitude_fixed);
    record.amplitude_per_condition = static_cast<float>(promise->amplitude_per_condition);
  }
  return records;
}

} // namespace pmdsim
