#include "host/output/page/page_plan.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

constexpr std::size_t enough_frames = 16; // for a slider to show what moves
constexpr std::size_t least_side = 16;    // pixels

double bytes_of(const std::vector<SensorSize> &sensors, const PagePlan &plan) {
  double bytes = 0.0;
  for (const SensorSize &sensor : sensors) {
    const std::size_t frames = (sensor.frames - 1) / plan.frame_step + 1;
    double of_frame = 0.0;
    for (std::size_t rank = 0; rank < sensor.bytes.size(); ++rank)
      of_frame += plan.has(static_cast<ChannelRank>(rank)) ? sensor.bytes[rank] : 0.0;
    bytes += static_cast<double>(frames) * of_frame / (plan.pixel_step * plan.pixel_step);
  }
  return bytes;
}

std::size_t most(const std::vector<SensorSize> &sensors, std::size_t SensorSize::*what) {
  return std::ranges::max(sensors, {}, what).*what;
}

std::string missing_text(const std::vector<std::string> &names) {
  constexpr std::size_t few = 6;
  if (names.size() == 1)
    return fmt::format("The channel {} is not here.", names.front());
  if (names.size() <= few)
    return fmt::format("The channels {} are not here.", fmt::join(names, ", "));
  return fmt::format("The {} channels from {} to {} are not here.", names.size(), names.front(),
                     names.back());
}

std::string ordinal(std::uint32_t number) {
  const std::uint32_t ones = number % 10, tens = number % 100 / 10;
  return fmt::format("{}{}", number,
                     tens == 1   ? "th"
                     : ones == 1 ? "st"
                     : ones == 2 ? "nd"
                     : ones == 3 ? "rd"
                                 : "th");
}

} // namespace

PagePlan plan_for(const std::vector<SensorSize> &sensors, double max_bytes) {
  const auto fits = [&](const PagePlan &plan) { return bytes_of(sensors, plan) <= max_bytes; };
  PagePlan plan;
  for (const ChannelRank rank : {ChannelRank::raw, ChannelRank::secondary, ChannelRank::main}) {
    plan.rank = rank;
    if (fits(plan))
      return plan;
  }
  const std::size_t frames = most(sensors, &SensorSize::frames), fewest = std::min(frames, enough_frames);
  const auto most_step = static_cast<std::uint32_t>(fewest > 1 ? (frames - 1) / (fewest - 1) : 1);
  const std::size_t side = std::max(most(sensors, &SensorSize::columns), most(sensors, &SensorSize::rows));
  while (true) {
    for (plan.frame_step = 1; plan.frame_step <= most_step; ++plan.frame_step)
      if (fits(plan))
        return plan;
    if (side / (2 * std::size_t{plan.pixel_step}) < least_side)
      break;
    plan.pixel_step *= 2;
  }
  plan.frame_step = most_step;
  return plan;
}

std::vector<std::string> left_out_text(const PagePlan &plan, std::size_t frames,
                                       const ChannelsByRank &channels) {
  std::vector<std::string> text;
  if (plan.frame_step > 1)
    text.push_back(fmt::format("Of {} frames only every {} is here.", frames, ordinal(plan.frame_step)));
  if (plan.pixel_step > 1)
    text.push_back(
        fmt::format("Only every {0} pixel of every {0} row is here, with the values that the files have.",
                    ordinal(plan.pixel_step)));
  for (const ChannelRank rank : {ChannelRank::secondary, ChannelRank::raw})
    if (const auto &names = channels.at(static_cast<std::size_t>(rank)); !plan.has(rank) && !names.empty())
      text.push_back(missing_text(names));
  return text;
}

} // namespace pmdsim
