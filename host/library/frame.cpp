// Frames: their channels and what is told of them.

#include "engine/lens/view_channels.h"
#include "host/library/calls.h"
#include "host/library/objects.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <variant>

namespace pmdsim::library {
namespace {

std::shared_ptr<FrameObject> frame_of(const pmdsim_frame *handle) {
  std::shared_ptr<FrameObject> frame = frames().get(handle);
  if (!frame)
    throw bad_handle("frame");
  return frame;
}

ChannelSet channels_of(const ReadFrame &frame) {
  ChannelSet set{frame.resolution, {}};
  for (const ReadChannel &channel : frame.channels)
    if (const auto *doubles = std::get_if<std::vector<double>>(&channel.values)) {
      set.channels.push_back({channel.name, channel.unit, std::span<const float>()});
      set.channels.back().unrounded = *doubles;
    } else if (const auto *floats = std::get_if<std::vector<float>>(&channel.values)) {
      set.channels.push_back({channel.name, channel.unit, std::span(*floats)});
    } else {
      set.channels.push_back(
          {channel.name, channel.unit, std::span(std::get<std::vector<std::uint32_t>>(channel.values))});
    }
  return set;
}

void tell(const FrameObject &frame, std::size_t index, pmdsim_channel *channel) {
  const Channel &of = frame.channels.channels[index];
  constexpr std::array types{PMDSIM_FLOAT32, PMDSIM_UINT32, PMDSIM_FLOAT64}; // of ChannelValues
  const ChannelValues known = written_values(of);
  const void *values = std::visit([](const auto &span) -> const void * { return span.data(); }, known);
  const pmdsim_channel told{
      sizeof(pmdsim_channel),      frame.names[index].c_str(),  of.unit.c_str(), types.at(known.index()),
      frame.channels.resolution.y, frame.channels.resolution.x, values};
  fill_struct(&told, sizeof(told), sizeof(told), &required(channel, "channel"), "channel");
}

void put_directions(const Sensor &sensor, std::span<double> to) {
  auto at = to.begin();
  for (const glm::dvec3 &ray : rays_of(sensor))
    for (glm::length_t i = 0; i < 3; ++i)
      *at++ = ray[i];
}

} // namespace

FrameObject::~FrameObject() {
  if (const auto alive = camera.lock(); alive && taken)
    alive->reuse(std::move(taken->measurement));
}

Handles<pmdsim_frame, FrameObject> &frames() {
  static Handles<pmdsim_frame, FrameObject> all;
  return all;
}

pmdsim_frame *add_frame(std::shared_ptr<FrameObject> frame) {
  for (const Channel &channel : frame->channels.channels)
    frame->names.push_back(channel.name());
  return frames().add(std::move(frame));
}

} // namespace pmdsim::library

using namespace pmdsim;
using namespace pmdsim::library;

pmdsim_status pmdsim_frame_read(const char *file, pmdsim_frame **frame) {
  return guarded([&] {
    required(frame, "frame");
    auto made = std::make_shared<FrameObject>();
    made->read = read_frame(&required(file, "file"));
    made->channels = channels_of(*made->read);
    *frame = add_frame(std::move(made));
  });
}

pmdsim_status pmdsim_frame_destroy(pmdsim_frame *frame) {
  return guarded([&] {
    if (frame && !frames().take(frame))
      throw bad_handle("frame");
  });
}

pmdsim_status pmdsim_frame_channel_count(const pmdsim_frame *frame, size_t *count) {
  return guarded([&] {
    const std::size_t channels = frame_of(frame)->channels.channels.size();
    required(count, "count") = channels;
  });
}

pmdsim_status pmdsim_frame_channel(const pmdsim_frame *frame, size_t index, pmdsim_channel *channel) {
  return guarded([&] {
    const auto of = frame_of(frame);
    if (index >= of->names.size())
      throw bad_argument(fmt::format("index: expected one below {}, found {}", of->names.size(), index));
    tell(*of, index, channel);
  });
}

pmdsim_status pmdsim_frame_find(const pmdsim_frame *frame, const char *name, pmdsim_channel *channel) {
  return guarded([&] {
    const auto of = frame_of(frame);
    const auto found = std::ranges::find(of->names, std::string(&required(name, "name")));
    if (found == of->names.end())
      throw bad_argument(fmt::format("name: the frame has no channel \"{}\", expected one of {}", name,
                                     fmt::join(of->names, ", ")));
    tell(*of, static_cast<std::size_t>(found - of->names.begin()), channel);
  });
}

pmdsim_status pmdsim_frame_report(const pmdsim_frame *frame, const char **json) {
  return guarded([&] {
    const auto of = frame_of(frame);
    required(json, "json") = of->report.c_str();
  });
}

pmdsim_status pmdsim_frame_directions(const pmdsim_frame *frame, double *directions, size_t length) {
  return guarded([&] {
    const auto of = frame_of(frame);
    if (!of->taken)
      throw bad_argument("frame: one that was read knows nothing of its lens");
    const std::size_t needed = 3 * of->taken->sensor.pixel_count();
    if (length < needed)
      throw bad_argument(fmt::format("length: expected room for {} values, found {}", needed, length));
    put_directions(of->taken->sensor, {&required(directions, "directions"), needed});
  });
}
