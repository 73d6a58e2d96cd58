#include "host/output/files/channel.h"

#include <fmt/format.h>

namespace pmdsim {

std::string channel_name(const std::string &quantity, const std::optional<std::size_t> &frequency) {
  return frequency ? fmt::format("f{}.{}", *frequency, quantity) : quantity;
}

std::optional<std::size_t> frequency_of(std::size_t index, std::size_t count) {
  return count > 1 ? std::optional(index) : std::nullopt;
}

ChannelValues written_values(const Channel &channel) {
  if (!channel.unrounded.empty())
    return channel.unrounded;
  return std::visit([](auto values) -> ChannelValues { return values; }, channel.values);
}

namespace {

std::span<const double> unrounded_values(const Measurement &measurement, const ChannelIndex &of) {
  return std::visit(
      [&](auto at) -> std::span<const double> {
        if constexpr (std::is_same_v<decltype(at), std::vector<double> Measurement::*>)
          return measurement.*at;
        else if constexpr (std::is_same_v<decltype(at), std::vector<double> Return::*>)
          return measurement.returns[of.frequency].*at;
        else
          return {};
      },
      of.row.unrounded);
}

} // namespace

ChannelSet channels_of(const Measurement &measurement) {
  ChannelSet set{measurement.resolution, {}};
  for_each_channel(measurement, [&](const ChannelIndex &of, const auto &values) {
    const std::string tap = is_of_taps(of.row) ? fmt::format("{}", of.tap) : "";
    const auto frequency =
        is_of_frequency(of.row) ? frequency_of(of.frequency, measurement.returns.size()) : std::nullopt;
    if (!values.empty())
      set.channels.push_back({std::string(of.row.name) + tap, std::string(of.row.unit), std::span(values),
                              frequency, of.row.preview, std::string(of.row.about),
                              unrounded_values(measurement, of)});
  });
  return set;
}

} // namespace pmdsim
