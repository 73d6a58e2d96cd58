#include "host/output/files/channel.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr const char *radiance = "W/(m² sr)";

void add_returns(std::vector<Channel> &channels, const std::vector<Return> &returns) {
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const auto frequency = frequency_of(i, returns.size());
    channels.push_back({"amplitude", radiance, std::span(returns[i].amplitude), frequency});
    channels.push_back({"phase_rad", "rad", std::span(returns[i].phase_rad), frequency});
    channels.push_back({"distance_m", "m", std::span(returns[i].distance_m), frequency});
  }
}

void add_taps(std::vector<Channel> &channels, const std::vector<Return> &returns) {
  for (std::size_t i = 0; i < returns.size(); ++i)
    for (std::size_t k = 0; k < returns[i].taps.size(); ++k)
      channels.push_back({fmt::format("tap{}", k), radiance, std::span(returns[i].taps[k]),
                          frequency_of(i, returns.size())});
}

} // namespace

std::string channel_name(const std::string &quantity, const std::optional<std::size_t> &frequency) {
  return frequency ? fmt::format("f{}.{}", *frequency, quantity) : quantity;
}

std::optional<std::size_t> frequency_of(std::size_t index, std::size_t count) {
  return count > 1 ? std::optional(index) : std::nullopt;
}

ChannelSet channels_of(const Measurement &measurement) {
  ChannelSet set{measurement.resolution, {}};
  add_returns(set.channels, measurement.returns);
  add_taps(set.channels, measurement.returns);
  set.channels.push_back({"range_m", "m", std::span(measurement.range_m)});
  set.channels.push_back({"z_m", "m", std::span(measurement.z_m)});
  set.channels.push_back({"coverage", "", std::span(measurement.coverage)});
  if (!measurement.lit.empty())
    set.channels.push_back({"lit", "", std::span(measurement.lit)});
  set.channels.push_back({"triangle_id", "", std::span(measurement.triangle_id)});
  set.channels.push_back({"object_id", "", std::span(measurement.object_id)});
  return set;
}

} // namespace pmdsim
