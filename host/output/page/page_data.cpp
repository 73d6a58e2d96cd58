#include "host/output/page/page_data.h"

#include "engine/model/error.h"
#include "host/input/frame/frame_file.h"
#include "host/output/page/channel_words.h"
#include "host/output/page/packed_values.h"
#include "host/output/pictures/colouring.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <type_traits>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

constexpr int most_tries = 8;

// A channel that a page has, with the words for it.
struct ShownChannel {
  ChannelWords words;
  ReadChannel channel;
};

struct ShownFrame {
  glm::uvec2 resolution;
  std::vector<ShownChannel> channels; // in the order of lists
};

template <class Value>
std::vector<Value> every(std::uint32_t step, const std::vector<Value> &values, const glm::uvec2 &resolution) {
  std::vector<Value> kept;
  for (std::size_t row = 0; row < resolution.y; row += step)
    for (std::size_t column = 0; column < resolution.x; column += step)
      kept.push_back(values[row * resolution.x + column]);
  return kept;
}

bool is_integer(const ReadChannel &channel) {
  return std::visit(
      [](const auto &values) { return std::is_integral_v<std::remove_cvref_t<decltype(values[0])>>; },
      channel.values);
}

ShownFrame shown_frame(const PageFrame &frame, const PagePlan &plan) {
  ReadFrame read = read_frame(frame.file);
  const bool is_corrected =
      std::ranges::find(read.channels, "correction_mm", &ReadChannel::name) != read.channels.end();
  ShownFrame shown{(read.resolution + plan.pixel_step - 1u) / plan.pixel_step, {}};
  for (ReadChannel &channel : read.channels) {
    ChannelWords words = is_corrected ? corrected_words_of(channel.name, is_integer(channel))
                                      : words_of(channel.name, is_integer(channel));
    if (!plan.has(words.rank))
      continue;
    if (plan.pixel_step > 1)
      std::visit([&](auto &values) { values = every(plan.pixel_step, values, read.resolution); },
                 channel.values);
    shown.channels.push_back({std::move(words), std::move(channel)});
  }
  std::ranges::stable_sort(shown.channels, {}, [](const ShownChannel &each) {
    return std::pair(each.words.at, each.words.frequency.value_or(0));
  });
  return shown;
}

std::string packed_channel(const ReadChannel &channel) {
  return std::visit(
      [](const auto &values) { return packed(std::as_bytes(std::span(values)), sizeof(values[0])); },
      channel.values);
}

// As numpy has it: 4 bytes a value, floats or unsigned numbers, or 8.
template <class Value>
std::string kind_of() {
  return fmt::format("{}{}", std::is_integral_v<Value> ? "u" : "f", sizeof(Value));
}

// Of quantities with a sign, too, the values' own range: the page makes it even about zero where that tells
// more.
void add_range(ordered_json &json, std::span<const float> values, PageScale scale) {
  const ColourScale as = scale == PageScale::turn    ? ColourScale::turn
                         : scale == PageScale::share ? ColourScale::share
                                                     : ColourScale::sequential;
  const Range range = colouring_of(spread_of_values(values), as).range;
  json["range"] = {range.min, range.max};
  std::vector<float> finite;
  std::ranges::copy_if(values, std::back_inserter(finite), [](float value) { return std::isfinite(value); });
  json["extent"] = finite.empty() ? ordered_json(nullptr)
                                  : ordered_json{std::ranges::min(finite), std::ranges::max(finite)};
}

ordered_json channel_json(const ShownChannel &shown, std::size_t block) {
  const ChannelWords &words = shown.words;
  ordered_json json{{"name", shown.channel.name}, {"quantity", words.quantity},
                    {"title", words.title},       {"group", words.group},
                    {"about", words.about},       {"none", words.none},
                    {"unit", shown.channel.unit}, {"scale", scale_name(words.scale)}};
  json["frequency"] = words.frequency ? ordered_json(*words.frequency) : ordered_json(nullptr);
  json["block"] = block;
  std::visit(
      [&](const auto &values) {
        using Value = std::remove_cvref_t<decltype(values[0])>;
        json["kind"] = kind_of<Value>();
        if constexpr (std::is_floating_point_v<Value>)
          add_range(json, std::vector<float>(values.begin(), values.end()), words.scale);
      },
      shown.channel.values);
  return json;
}

SensorSize size_of(const PageSensor &sensor, ChannelsByRank &channels) {
  const ShownFrame first = shown_frame(sensor.frames.front(), {});
  SensorSize size{sensor.frames.size(), first.resolution.x, first.resolution.y};
  for (const ShownChannel &each : first.channels) {
    const auto rank = static_cast<std::size_t>(each.words.rank);
    size.bytes.at(rank) += static_cast<double>(packed_channel(each.channel).size());
    if (std::vector<std::string> &names = channels.at(rank);
        std::ranges::find(names, each.channel.name) == names.end())
      names.push_back(each.channel.name);
  }
  return size;
}

void add_frame(PageData &data, ordered_json &frames, const RunContent &run, const PageSensor &sensor,
               const PageFrame &frame) {
  const ShownFrame shown = shown_frame(frame, data.plan);
  ordered_json json{{"frame", frame.number},
                    {"entry", frame.entry},
                    {"columns", shown.resolution.x},
                    {"rows", shown.resolution.y},
                    {"channels", ordered_json::array()}};
  for (const ShownChannel &each : shown.channels) {
    json["channels"].push_back(channel_json(each, data.blocks.size()));
    data.blocks.push_back(packed_channel(each.channel));
    data.block_bytes += data.blocks.back().size();
  }
  json.update(times_of(run, sensor.name, frame.number));
  frames.push_back(std::move(json));
}

// With what `data` has as its plan; whether it has stayed within `max_bytes`, beyond which it is not
// finished.
bool fill(PageData &data, const RunContent &run, std::size_t max_bytes, const std::function<void()> &check) {
  data.sensors = ordered_json::array();
  data.blocks.clear();
  data.block_bytes = 0;
  for (const PageSensor &sensor : run.sensors) {
    ordered_json frames = ordered_json::array();
    for (std::size_t i = 0; i < sensor.frames.size(); i += data.plan.frame_step) {
      check();
      add_frame(data, frames, run, sensor, sensor.frames[i]);
      if (data.block_bytes > max_bytes)
        return false;
    }
    data.sensors.push_back({{"name", sensor.name}, {"frames", std::move(frames)}});
  }
  return true;
}

} // namespace

PageData page_data(const RunContent &run, const PageRoom &room, const std::function<void()> &check) {
  PageData data;
  std::vector<SensorSize> sizes;
  for (const PageSensor &sensor : run.sensors) {
    check();
    sizes.push_back(size_of(sensor, data.channels));
    data.frames = std::max(data.frames, sensor.frames.size());
  }
  // Frames differ in size from the first, and few pixels are packed less tightly than many: where too much
  // came out, a smaller plan is tried.
  auto planned_bytes = static_cast<double>(room.wanted_bytes);
  for (int i = 0; i < most_tries; ++i, planned_bytes *= 0.8) {
    data.plan = plan_for(sizes, planned_bytes);
    if (fill(data, run, room.wanted_bytes, check))
      return data;
  }
  if (!fill(data, run, room.most_bytes, check)) // it is as small as it gets
    throw Error(ExitCode::input,
                fmt::format("{}: a page has no room for frames that are so much larger than its first, "
                            "--frames chooses fewer",
                            run.directory.string()));
  return data;
}

} // namespace pmdsim
