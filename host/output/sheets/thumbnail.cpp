#include "host/output/sheets/thumbnail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint32_t no_level = 4095, last_level = no_level - 1; // 12 bits
constexpr std::array<std::string_view, 4> shown{"amplitude", "distance_m", "unwrapped_distance_m",
                                                "deformation_mm"};
constexpr std::array<std::string_view, 2> scale_names{"sequential", "zero_centred"};
constexpr std::size_t longest_text = 200; // of a name in a record

std::string_view name_of(ColourScale scale) {
  return scale == ColourScale::zero_centred ? scale_names[1] : scale_names[0];
}

std::uint32_t level_of(float value, const Range &range) {
  if (!std::isfinite(value))
    return no_level;
  const double place = range.span() > 0.0 ? along(range, static_cast<double>(value), 1.0) : 0.0;
  return static_cast<std::uint32_t>(std::lround(std::clamp(place, 0.0, 1.0) * last_level));
}

float value_of(std::uint32_t level, const Range &range) {
  if (level == no_level)
    return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(range.min + range.span() * level / last_level);
}

std::optional<std::vector<float>> values_of(const std::string &text, std::size_t count, const Range &range) {
  if (text.size() != 2 * count)
    return std::nullopt;
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t high = digits.find(text[2 * i]), low = digits.find(text[2 * i + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos)
      return std::nullopt;
    values.push_back(value_of(static_cast<std::uint32_t>(64 * high + low), range));
  }
  return values;
}

// A size that is 1 to `most` a side; {0, 0} where it is none.
glm::uvec2 size_in(const ordered_json &json, std::uint32_t most) {
  if (!json.is_array() || json.size() != 2)
    return {0, 0};
  glm::uvec2 size(0);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!json[i].is_number_unsigned() || json[i] < 1 || json[i] > most)
      return {0, 0};
    size[static_cast<glm::length_t>(i)] = json[i].get<std::uint32_t>();
  }
  return size;
}

std::string text_in(const ordered_json &json) {
  const auto &text = json.get_ref<const std::string &>();
  return text.size() <= longest_text ? text : std::string();
}

std::optional<Range> range_in(const ordered_json &json) {
  const Range range{json.at(0).get<double>(), json.at(1).get<double>()};
  constexpr double largest = std::numeric_limits<float>::max();
  const bool is_range = range.span() >= 0.0 && range.min >= -largest && range.max <= largest;
  return is_range ? std::optional(range) : std::nullopt;
}

} // namespace

std::vector<Thumbnail> thumbnails_of(const ChannelSet &channels) {
  std::vector<Thumbnail> thumbnails;
  for (const Channel &channel : channels.channels) {
    if (!channel.preview || channel.frequency.value_or(0) != 0 ||
        std::ranges::find(shown, channel.quantity) == shown.end())
      continue;
    const ColourScale scale = channel.preview->scale;
    thumbnails.push_back({channel.name(), std::string(channel.preview->quantity), channel.unit, scale,
                          channels.resolution,
                          shrunk_image(std::get<std::span<const float>>(channel.values), channels.resolution,
                                       scale, max_thumbnail_side)});
  }
  return thumbnails;
}

ordered_json thumbnail_json(const Thumbnail &thumbnail) {
  const ValueSpread spread = spread_of_values(thumbnail.image.values);
  std::string text;
  text.reserve(2 * thumbnail.image.values.size());
  for (const float value : thumbnail.image.values) {
    const std::uint32_t level = level_of(value, spread.robust);
    text += digits[level / 64];
    text += digits[level % 64];
  }
  const glm::uvec2 &frame = thumbnail.frame_resolution, &resolution = thumbnail.image.resolution;
  return {{"channel", thumbnail.channel},
          {"quantity", thumbnail.quantity},
          {"unit", thumbnail.unit},
          {"scale", name_of(thumbnail.scale)},
          {"frame_resolution", {frame.x, frame.y}},
          {"resolution", {resolution.x, resolution.y}},
          {"range", {spread.robust.min, spread.robust.max}},
          {"values", text}};
}

std::optional<Thumbnail> parsed_thumbnail(const ordered_json &json) {
  try {
    Thumbnail thumbnail{text_in(json.at("channel")),
                        text_in(json.at("quantity")),
                        text_in(json.at("unit")),
                        json.at("scale") == scale_names[1] ? ColourScale::zero_centred
                                                           : ColourScale::sequential,
                        size_in(json.at("frame_resolution"), std::numeric_limits<std::uint32_t>::max()),
                        {size_in(json.at("resolution"), max_thumbnail_side), {}, 1}};
    const glm::uvec2 &size = thumbnail.image.resolution;
    const std::optional<Range> range = range_in(json.at("range"));
    if (thumbnail.channel.empty() || size.x == 0 || thumbnail.frame_resolution.x == 0 || !range)
      return std::nullopt;
    auto values =
        values_of(json.at("values").get_ref<const std::string &>(), std::size_t{size.x} * size.y, *range);
    if (!values)
      return std::nullopt;
    thumbnail.image.values = std::move(*values);
    return thumbnail;
  } catch (const nlohmann::json::exception &) {
    return std::nullopt;
  }
}

} // namespace pmdsim
