#include "host/output/page/page_plan.h"

#include <algorithm>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr std::size_t enough_frames = 16; // for a slider to show what moves
constexpr std::size_t least_side = 16;    // pixels

double bytes_of(const std::vector<SensorSize> &sensors, const PagePlan &plan) {
  double bytes = 0.0;
  for (const SensorSize &sensor : sensors) {
    const double frames = static_cast<double>((sensor.frames - 1) / plan.frame_step + 1);
    const double of_frame = sensor.other_bytes + (plan.has_raw ? sensor.raw_bytes : 0.0);
    bytes += frames * of_frame / (plan.pixel_step * plan.pixel_step);
  }
  return bytes;
}

std::size_t most(const std::vector<SensorSize> &sensors, std::size_t SensorSize::*what) {
  return std::ranges::max(sensors, {}, what).*what;
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
  if (fits({}))
    return {};
  const std::size_t frames = most(sensors, &SensorSize::frames);
  const std::size_t side = std::max(most(sensors, &SensorSize::columns), most(sensors, &SensorSize::rows));
  PagePlan plan{1, 1, false};
  for (;; plan.pixel_step *= 2) {
    const std::size_t fewest = std::min(frames, enough_frames);
    for (plan.frame_step = 1; (frames - 1) / plan.frame_step + 1 >= fewest; ++plan.frame_step)
      if (fits(plan) || fewest == 1)
        break;
    if (fits(plan))
      return plan;
    if (side / (2 * std::size_t{plan.pixel_step}) < least_side) {
      plan.frame_step = static_cast<std::uint32_t>(std::max<std::size_t>(1, (frames - 1) / fewest));
      return plan;
    }
  }
}

std::vector<std::string> left_out_text(const PagePlan &plan, std::size_t frames,
                                       const std::vector<std::string> &raw_channels) {
  std::vector<std::string> text;
  if (plan.frame_step > 1)
    text.push_back(fmt::format("Of {} frames only every {} is here.", frames, ordinal(plan.frame_step)));
  if (plan.pixel_step > 1)
    text.push_back(
        fmt::format("Only every {0} pixel of every {0} row is here, with the values that the files have.",
                    ordinal(plan.pixel_step)));
  if (!plan.has_raw && !raw_channels.empty())
    text.push_back(raw_channels.size() == 1
                       ? fmt::format("The channel {} is not here.", raw_channels.front())
                       : fmt::format("The {} channels from {} to {} are not here.", raw_channels.size(),
                                     raw_channels.front(), raw_channels.back()));
  return text;
}

} // namespace pmdsim
