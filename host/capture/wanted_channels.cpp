#include "host/capture/wanted_channels.h"

#include "engine/model/channel_names.h"
#include "engine/model/error.h"
#include "host/input/words/near_name.h"
#include "host/input/words/quotes.h"

#include <fmt/format.h>
#include <map>
#include <type_traits>
#include <utility>

namespace pmdsim {
namespace {

bool is_one_of(const ChannelRow &row, std::initializer_list<ChannelMember> members) {
  return std::ranges::find(members, row.at) != members.end();
}

bool is_noiseless(const ChannelRow &row) {
  return is_one_of(
      row, {&Return::amplitude_noiseless, &Return::phase_rad_noiseless, &Return::distance_m_noiseless});
}

// Of frames of the sensor that have it.
FramePart part_of(const ChannelRow &row, const Sensor &sensor) {
  switch (row.slot.area) {
  case DeviceSlot::Area::truth:
  case DeviceSlot::Area::view:
    return FramePart::truth;
  case DeviceSlot::Area::shadow:
    return FramePart::visibility;
  case DeviceSlot::Area::none:
    return is_one_of(row, {&Return::direct_amplitude, &Return::direct_phase_rad, &Return::direct_distance_m})
               ? FramePart::direct_light
               : FramePart::light;
  case DeviceSlot::Area::bound:
  case DeviceSlot::Area::mean:
    return FramePart::light;
  case DeviceSlot::Area::electrons:
    return is_noiseless(row) ? FramePart::light : FramePart::electrons;
  case DeviceSlot::Area::unwrapped:
    return FramePart::electrons;
  case DeviceSlot::Area::frequency:
    if (is_one_of(row, {&Measurement::range_m}))
      return FramePart::truth;
    return sensor.electronics ? FramePart::electrons : FramePart::light;
  }
  return FramePart::electrons;
}

// The values of the channel, in a frame that may not have room for them yet.
template <class Values>
Values &values_of(Measurement &frame, const ChannelIndex &channel) {
  if (frame.returns.size() <= channel.frequency)
    frame.returns.resize(channel.frequency + 1);
  Return &returned = frame.returns[channel.frequency];
  Values *values = nullptr;
  std::visit(
      [&](auto at) {
        if constexpr (std::is_same_v<decltype(at), Values Measurement::*>) {
          values = &(frame.*at);
        } else if constexpr (std::is_same_v<decltype(at), Values Return::*>) {
          values = &(returned.*at);
        } else if constexpr (std::is_same_v<decltype(at), std::vector<Values> Return::*>) {
          (returned.*at).resize(std::max((returned.*at).size(), channel.tap + 1));
          values = &(returned.*at)[channel.tap];
        }
      },
      channel.row.at);
  return *values;
}

// Of a channel that may be there in double, too; in a frame that has room for it.
std::vector<double> &unrounded_of(Measurement &frame, const ChannelIndex &channel) {
  if (const auto of_frame = std::get_if<std::vector<double> Measurement::*>(&channel.row.unrounded))
    return frame.**of_frame;
  return frame.returns[channel.frequency].*std::get<std::vector<double> Return::*>(channel.row.unrounded);
}

template <class Which>
void move_values(Measurement &from, Measurement &to, const Which &which) {
  for_each_channel(from, [&](const ChannelIndex &channel, auto &values) {
    if (values.empty() || !which(channel))
      return;
    auto &there = values_of<std::remove_cvref_t<decltype(values)>>(to, channel);
    if (there.empty())
      there = std::exchange(values, {});
  });
  for_each_unrounded(from, [&](const ChannelIndex &channel, auto &, std::vector<double> &unrounded) {
    if (unrounded.empty() || !which(channel))
      return;
    std::vector<double> &there = unrounded_of(to, channel);
    if (there.empty())
      there = std::exchange(unrounded, {});
  });
}

Error no_such_channel(const std::string &problem, const std::vector<std::string> &known) {
  return {ExitCode::usage, fmt::format("--channels: {}, expected of {}", problem, fmt::join(known, ", "))};
}

constexpr std::string_view all_name = "all";

// Channels that one name stands for.
const std::map<std::string, std::vector<std::string>> &channel_groups() {
  static const std::map<std::string, std::vector<std::string>> groups{
      {"normals", {"normal_x", "normal_y", "normal_z"}}, {"rays", {"ray_x", "ray_y", "ray_z"}}};
  return groups;
}

Error unknown_channel(const std::string &name, std::vector<std::string> known) {
  for (const ChannelRow &row : channel_rows)
    known.emplace_back(row.name);
  for (const auto &[group, names] : channel_groups())
    known.push_back(group);
  known.emplace_back(all_name);
  const std::string meant = did_you_mean(name, known);
  if (!meant.empty())
    return {ExitCode::usage, fmt::format("--channels: unknown channel {}{}", in_quotes(name), meant)};
  return no_such_channel("unknown channel " + in_quotes(name), known);
}

// That it has, or may have, when it is measured like that.
bool may_have(const ChannelRow &row, const Setup &setup, const Sensor &sensor, const Accuracy &accuracy) {
  if (row.slot.area == DeviceSlot::Area::shadow)
    return setup.shadows == Shadows::automatic;
  if (row.slot.area == DeviceSlot::Area::bound)
    return accuracy.mode != Mode::exact;
  return has_channel(row, sensor, setup.bounces);
}

} // namespace

WantedChannels::WantedChannels(const std::vector<std::string> &names,
                               const std::vector<std::string> &own_names)
    : are_all_(std::ranges::find(names, all_name) != names.end()), names_(names), own_names_(own_names) {
  for (const std::string &name : names) {
    const auto group = channel_groups().find(name);
    if (group != channel_groups().end())
      std::ranges::for_each(group->second, [&](const std::string &each) { add(each); });
    else if (name != all_name)
      add(name);
  }
  if (names.empty())
    throw Error(ExitCode::usage, "--channels: expected at least one name");
  std::ranges::sort(names_); // the same channels in another order are the same run
  names_.erase(std::ranges::unique(names_).begin(), names_.end());
}

void WantedChannels::add(const std::string &name) {
  const ChannelName found = channel_named(name);
  const bool is_own = std::ranges::find(own_names_, name) != own_names_.end();
  if (!is_own && (!found.row || found.tap))
    throw unknown_channel(name, own_names_);
  wanted_.push_back({is_own ? nullptr : found.row, found.frequency, name});
}

bool WantedChannels::has(const ChannelIndex &channel) const {
  return (are_all() && !is_on_demand(channel.row)) || std::ranges::any_of(wanted_, [&](const Wanted &wanted) {
           return wanted.row == &channel.row && (!wanted.frequency || *wanted.frequency == channel.frequency);
         });
}

bool WantedChannels::has(const ChannelRow &row) const {
  return (are_all() && !is_on_demand(row)) || std::ranges::find(wanted_, &row, &Wanted::row) != wanted_.end();
}

bool WantedChannels::has_own(const std::string &name) const {
  return are_all() || std::ranges::find(names_, name) != names_.end();
}

bool WantedChannels::have_taps() const {
  return std::ranges::any_of(channel_rows,
                             [&](const ChannelRow &row) { return is_of_taps(row) && has(row); });
}

bool WantedChannels::have_previews() const {
  return !own_names_.empty() ||
         std::ranges::any_of(channel_rows, [&](const ChannelRow &row) { return row.preview && has(row); });
}

WantedChannels WantedChannels::with(const ChannelRow &row) const {
  WantedChannels more = *this;
  if (!are_all())
    more.wanted_.push_back({&row, std::nullopt, std::string(row.name)});
  return more;
}

bool WantedChannels::is_there(const Wanted &wanted, const Setup &setup, const Sensor &sensor,
                              const Accuracy &accuracy) {
  return !wanted.row || (may_have(*wanted.row, setup, sensor, accuracy) &&
                         wanted.frequency.value_or(0) < sensor.modulation_hz.size());
}

void WantedChannels::require_in(const Setup &setup, const Accuracy &accuracy) const {
  const std::vector<Sensor> &sensors = setup.start.sensors;
  std::vector<std::string> known = own_names_;
  for (const ChannelRow &row : channel_rows)
    if (std::ranges::any_of(sensors, [&](const Sensor &of) { return may_have(row, setup, of, accuracy); }))
      known.emplace_back(row.name);
  for (const Wanted &wanted : wanted_)
    if (std::ranges::none_of(sensors,
                             [&](const Sensor &of) { return is_there(wanted, setup, of, accuracy); }))
      throw no_such_channel(fmt::format("no frame of {} has {}", setup.file.string(), in_quotes(wanted.name)),
                            known);
  for (const Sensor &sensor : sensors) // error_bound_m alone may turn out to be absent
    if (!are_all() && std::ranges::none_of(wanted_, [&](const Wanted &wanted) {
          return is_there(wanted, setup, sensor, accuracy) &&
                 (!wanted.row || wanted.row->slot.area != DeviceSlot::Area::bound);
        }))
      throw no_such_channel(fmt::format("frames of the sensor {} would be empty", in_quotes(sensor.name)),
                            known);
}

bool has_channel(const ChannelRow &row, const Sensor &sensor, const Bounces &bounces) {
  switch (row.slot.area) {
  case DeviceSlot::Area::none:
    return bounces.any();
  case DeviceSlot::Area::mean:
    return sensor.electronics.has_value();
  case DeviceSlot::Area::electrons:
    return sensor.electronics && (!is_noiseless(row) || sensor.electronics->noiseless_channels) &&
           (!is_one_of(row, {&Return::tap_b_e, &Return::tap_b_dn}) || sensor.electronics->two_tap);
  case DeviceSlot::Area::unwrapped:
    return sensor.unwrap_range_m > 0.0;
  default:
    return true;
  }
}

FramePart part_of(const WantedChannels &wanted, const Sensor &sensor, const Bounces &bounces,
                  const Accuracy &accuracy) {
  // Within an error the light decides at how many points of a pixel even the truth is looked up.
  const bool depends_on_light = accuracy.mode != Mode::exact || sensor.adaptive_samples;
  FramePart part = depends_on_light ? FramePart::light : FramePart::truth;
  for (const ChannelRow &row : channel_rows)
    if (wanted.has(row) && has_channel(row, sensor, bounces))
      part = std::max(part, part_of(row, sensor));
  return part;
}

bool leaves_noiseless(const WantedChannels &wanted, const std::vector<Sensor> &sensors) {
  const auto is_wanted = [&](const ChannelRow &row) { return is_noiseless(row) && wanted.has(row); };
  const auto can_leave = [](const Sensor &sensor) {
    return !sensor.electronics || sensor.electronics->noiseless_channels;
  };
  return std::ranges::none_of(channel_rows, is_wanted) && std::ranges::all_of(sensors, can_leave);
}

Sensor reduced_to(const WantedChannels &wanted, FramePart part, bool leaves_noiseless, Sensor sensor) {
  if (part <= FramePart::visibility) {
    sensor.modulation_hz.resize(1);
    sensor.waveform = {};
    sensor.electronics.reset();
  }
  if (part < FramePart::light)
    sensor.scatter.clear();
  const bool unwraps =
      wanted.has(row_of(&Measurement::unwrapped_distance_m)) || wanted.has(row_of(&Measurement::unwrap_ok));
  if (part < FramePart::electrons || !unwraps)
    sensor.unwrap_range_m = 0.0;
  // The device counts no electrons of sensors with noiseless channels.
  if (sensor.electronics && part < FramePart::electrons)
    sensor.electronics->noiseless_channels = true;
  else if (sensor.electronics && leaves_noiseless)
    sensor.electronics->noiseless_channels = false;
  return sensor;
}

void name_light(FramePart part, const Sensor &sensor, Measurement &frame) {
  const bool is_direct = part == FramePart::direct_light;
  const bool is_noiseless = part == FramePart::light && sensor.electronics;
  for (Return &of : frame.returns) {
    if (is_direct) {
      of.direct_amplitude = std::exchange(of.amplitude, {});
      of.direct_phase_rad = std::exchange(of.phase_rad, {});
      of.direct_distance_m = std::exchange(of.distance_m, {});
      of.unrounded_direct_distance_m = std::exchange(of.unrounded_distance_m, {});
    }
    if (is_noiseless) {
      of.amplitude_noiseless = std::exchange(of.amplitude, {});
      of.phase_rad_noiseless = std::exchange(of.phase_rad, {});
      of.distance_m_noiseless = std::exchange(of.distance_m, {});
      of.unrounded_distance_m_noiseless = std::exchange(of.unrounded_distance_m, {});
    }
  }
}

void move_unwanted(const WantedChannels &wanted, Measurement &from, Measurement &to) {
  move_values(from, to, [&](const ChannelIndex &channel) { return !wanted.has(channel); });
}

void move_missing(Measurement &from, Measurement &to) {
  move_values(from, to, [](const ChannelIndex &) { return true; });
}

} // namespace pmdsim
