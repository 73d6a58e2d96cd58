#include "engine/frame/spot_check.h"

#include "engine/sampling/pixel_lists.h"
#include "engine/signal/channel_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace pmdsim {
namespace {

constexpr std::uint32_t checked_pixels = 1024;

// Pixels of a frame, counted row by row; each once, as two invocations must not work on the same sample.
std::set<std::uint32_t> choose_pixels(std::uint64_t count) {
  std::mt19937_64 random(1); // whose numbers the standard fixes
  std::set<std::uint32_t> pixels;
  while (pixels.size() < std::min<std::uint64_t>(count, checked_pixels))
    pixels.insert(static_cast<std::uint32_t>(random() % count));
  return pixels;
}

std::vector<std::vector<std::uint32_t>> by_strip(const std::set<std::uint32_t> &pixels,
                                                 const std::vector<PlannedStrip> &strips) {
  std::vector<std::vector<std::uint32_t>> result(strips.size());
  for (const std::uint32_t pixel : pixels)
    for (std::size_t i = 0; i < strips.size(); ++i) {
      const shader::Strip &strip = strips[i].strip;
      const std::uint32_t column = pixel % strip.resolution_x - strip.column;
      const std::uint32_t row = pixel / strip.resolution_x - strip.row; // wraps where it is before the strip
      if (column < strip.columns && row < strip.rows)
        result[i].push_back(row * strip.columns + column);
    }
  return result;
}

float channel_value(const StripBuffers &buffers, const shader::Strip &strip, std::uint32_t channel,
                    std::uint32_t pixel) {
  const shader::uvec2 pair = pair_for_host(buffers, strip, channel / 2 * 2)[pixel];
  return std::bit_cast<float>(channel % 2 == 0 ? pair.x : pair.y);
}

// 0 where neither is known, infinite where only one is.
double difference(double found, double exact) {
  if (std::isnan(found) || std::isnan(exact))
    return std::isnan(found) && std::isnan(exact) ? 0.0 : std::numeric_limits<double>::infinity();
  return std::abs(found - exact);
}

double relative_difference(double found, double exact) {
  const double apart = difference(found, exact);
  return apart == 0.0 ? 0.0 : apart / std::abs(exact);
}

double wrapped(double difference_m, double ambiguity_m) {
  return std::isfinite(difference_m) ? std::abs(std::remainder(difference_m, ambiguity_m)) : difference_m;
}

} // namespace

SpotCheck::SpotCheck(const PassSetup &on, const std::vector<PlannedStrip> &strips)
    : modulation_(on.modulation), of_strip_(by_strip(choose_pixels(on.sensor.pixel_count()), strips)),
      list_(std::make_shared<const vulkan::Buffer>(make_pixel_list(on.device, checked_pixels))) {}

Pass SpotCheck::list_pass() const {
  return {.name = "points",
          .reads = no_resource,
          .writes = pixel_lists,
          .record = [pixels = of_strip_, list = list_](const Recording &at) {
            const std::uint32_t side = at.of_strip().samples;
            record_fill(at.commands, *list, pixels[at.strip], side * side);
          }};
}

void SpotCheck::compare(std::size_t strip, const shader::Strip &of, const StripBuffers &buffers,
                        double limit_m, Measurement &measured) const {
  AccuracyReport &report = measured.accuracy;
  const ChannelLayout layout(modulation_);
  double distance_m = report.found_m.value_or(0.0), amplitude = report.found_amplitude.value_or(0.0);
  for (const std::uint32_t pixel : of_strip_[strip])
    for (std::uint32_t f = 0; f < modulation_.modulations(); ++f) {
      const std::size_t at =
          std::size_t{of.row + pixel / of.columns} * of.resolution_x + of.column + pixel % of.columns;
      const auto exact = [&](std::vector<float> Return::*channel) -> double {
        return static_cast<double>(channel_value(buffers, of, layout.number({row_of(channel), f}), pixel));
      };
      const double ambiguity_m = speed_of_light_m_s / (2.0 * modulation_.modulation_hz[f]);
      const Return &found = measured.returns[f];
      if (!found.error_bound_m.empty() && static_cast<double>(found.error_bound_m[at]) > limit_m)
        continue;
      double found_m = static_cast<double>(found.distance_m[at]), exact_m = exact(&Return::distance_m);
      if (layout.rests) {
        found_m = found.unrounded_distance_m[at];
        exact_m += static_cast<double>(channel_value(buffers, of, layout.rest_channels(f), pixel));
      }
      distance_m = std::max(distance_m, wrapped(difference(found_m, exact_m), ambiguity_m));
      amplitude = std::max(amplitude, relative_difference(static_cast<double>(found.amplitude[at]),
                                                          exact(&Return::amplitude)));
    }
  report.found_m = distance_m;
  report.found_amplitude = amplitude;
  report.checked_pixels += of_strip_[strip].size();
}

} // namespace pmdsim
