#pragma once
// The output channels of a frame, a row each, in the order in which files, help and documents list them. A
// new channel takes a row here, a member of Return or Measurement, and its value in
// shaders/signal/demodulation.glsl; memory, read-back, files, previews and help read the rows.

#include "engine/model/measurement.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace pmdsim {

// Where a channel lies: in the frame, in what each frequency returns, or there once for each tap.
using ChannelMember =
    std::variant<std::vector<float> Measurement::*, std::vector<std::uint32_t> Measurement::*,
                 std::vector<float> Return::*, std::vector<std::uint32_t> Return::*,
                 std::vector<std::vector<float>> Return::*>;

// Where the same values lie in double, if anywhere: before they were rounded to float. Empty unless they are
// asked for.
using UnroundedMember =
    std::variant<std::monostate, std::vector<double> Measurement::*, std::vector<double> Return::*>;

// Where a channel lies on the device, which keeps them in areas one behind the other: `index` counts from the
// beginning of the area. Channels 2 n and 2 n + 1 are stored as a pair, so what a shader stores together
// should have such numbers; each area ends with a whole pair.
struct DeviceSlot {
  enum class Area {
    truth, // stored with the first frequency; the host may read all of it off the samples' records instead
    frequency, // one area for each; taps come last. A channel of the frame is read from the first
    shadow,    // only where something may stand in the light
    bound,     // behind each frequency's taps; only where it is asked for
    mean,      // only where the sensor has electronics
    none,      // not there: the host makes them of what it reads back, where light bounces
    electrons, // likewise, where the sensor has electronics
    unwrapped, // likewise, where distances are unwrapped
    view,      // likewise, where it is asked for by name
  };
  Area area;
  std::uint32_t index; // of a tap: that of tap 0
};

// The values that the ends of a picture's colours stand for.
enum class ColourScale {
  sequential,   // from the least to the greatest value, but for the outermost 0.5 % on either side
  zero_centred, // the same, made symmetric about zero where the values are not far from it
  turn,         // always [0, 2 pi)
  share,        // always [0, 1]
  category,     // ids: a colour each
};

struct Preview {
  std::string_view quantity; // "distance", as titles and colour bars name it
  ColourScale scale;
};

struct ChannelRow {
  std::string_view name; // in files; taps add their number to it
  std::string_view unit; // "" for ids and shares
  std::string_view about;
  ChannelMember at; // empty where the channel is absent
  DeviceSlot slot;
  std::optional<Preview> preview = std::nullopt; // nothing: no picture is made of it
  UnroundedMember unrounded = std::monostate{};
};

inline constexpr std::string_view radiance_unit = "W/(m² sr)";

inline constexpr std::array channel_rows = [] {
  using Area = DeviceSlot::Area;
  using Scale = ColourScale;
  return std::to_array<ChannelRow>({
      {"amplitude",
       radiance_unit,
       "mean modulated radiance, abs z",
       &Return::amplitude,
       {Area::frequency, 0},
       Preview{"amplitude", Scale::sequential}},
      {"phase_rad",
       "rad",
       "arg z, 0 to 2 pi; NaN where nothing returns",
       &Return::phase_rad,
       {Area::frequency, 1},
       Preview{"phase", Scale::turn}},
      {"distance_m",
       "m",
       "c phase / (4 pi f), wraps at c / (2 f)",
       &Return::distance_m,
       {Area::frequency, 2},
       Preview{"distance", Scale::sequential},
       &Return::unrounded_distance_m},
      {"tap", radiance_unit, "the correlation samples", &Return::taps, {Area::frequency, 4}},
      {"tap_a_e",
       "e",
       "electrons of tap A of each image before the ADC; only with electronics, as those below",
       &Return::tap_a_e,
       {Area::electrons, 0}},
      {"tap_b_e", "e", "of tap B, of two taps", &Return::tap_b_e, {Area::electrons, 1}},
      {"tap_a_dn", "DN", "digital numbers of tap A", &Return::tap_a_dn, {Area::electrons, 2}},
      {"tap_b_dn", "DN", "of tap B, of two taps", &Return::tap_b_dn, {Area::electrons, 3}},
      {"saturated",
       "bits",
       "bit k: tap A of image k was full or beyond the ADC's range, bit 16 + k: tap B",
       &Return::saturated,
       {Area::electrons, 4}},
      {"distance_noise_m",
       "m",
       "predicted standard deviation of distance_m; NaN where nothing returns or a tap is full",
       &Return::distance_noise_m,
       {Area::electrons, 5},
       Preview{"distance noise", Scale::sequential}},
      {"confidence",
       "",
       "amplitude over the predicted standard deviation of z's real or imaginary part",
       &Return::confidence,
       {Area::electrons, 6}},
      {"amplitude_noiseless",
       radiance_unit,
       "amplitude without noise; only with \"noiseless_channels\"",
       &Return::amplitude_noiseless,
       {Area::electrons, 7}},
      {"phase_rad_noiseless",
       "rad",
       "phase_rad without noise, likewise",
       &Return::phase_rad_noiseless,
       {Area::electrons, 8}},
      {"distance_m_noiseless",
       "m",
       "distance_m without noise, likewise",
       &Return::distance_m_noiseless,
       {Area::electrons, 9},
       Preview{"distance without noise", Scale::sequential},
       &Return::unrounded_distance_m_noiseless},
      {"error_bound_m",
       "m",
       "how far distance_m without noise is off at most; only where an error was asked for that some pixels "
       "may exceed",
       &Return::error_bound_m,
       {Area::bound, 0}},
      {"multipath_m",
       "m",
       "distance with bounces minus that without, wrapped; NaN where either is; only with bounces",
       &Return::multipath_m,
       {Area::none, 0},
       Preview{"multipath", Scale::zero_centred}},
      {"multipath_error_m",
       "m",
       "how far multipath_m is off, estimated: no more in 95 % of the pixels; only with bounces",
       &Return::multipath_error_m,
       {Area::none, 1}},
      {"indirect_share",
       "",
       "abs of what bounced over abs z; 1 where no light comes directly, may exceed 1 where both cancel; "
       "only "
       "with bounces",
       &Return::indirect_share,
       {Area::none, 2},
       Preview{"indirect share", Scale::sequential}},
      {"direct_amplitude",
       radiance_unit,
       "amplitude without bounces; only with bounces",
       &Return::direct_amplitude,
       {Area::none, 3}},
      {"direct_phase_rad",
       "rad",
       "phase_rad without bounces; only with bounces",
       &Return::direct_phase_rad,
       {Area::none, 4}},
      {"direct_distance_m",
       "m",
       "distance_m without bounces; only with bounces",
       &Return::direct_distance_m,
       {Area::none, 5},
       std::nullopt,
       &Return::unrounded_direct_distance_m},
      {"range_m",
       "m",
       "ground truth: mean distance to the lens",
       &Measurement::range_m,
       {Area::frequency, 3},
       std::nullopt,
       &Measurement::unrounded_range_m},
      {"z_m", "m", "ground truth: mean depth", &Measurement::z_m, {Area::truth, 1}},
      {"coverage",
       "",
       "share of the pixel's samples that hit the scene",
       &Measurement::coverage,
       {Area::truth, 0}},
      {"lit",
       "",
       "mean visibility: share of the diodes that reach the pixel, mean over its samples that hit; 0 where "
       "none does; absent with \"shadows\": \"off\"",
       &Measurement::lit,
       {Area::shadow, 0},
       Preview{"lit", Scale::share}},
      {"mean_radiance",
       radiance_unit,
       "mean radiance of all diodes' light, other cameras' included, noiseless; only with electronics",
       &Measurement::mean_radiance,
       {Area::mean, 0}},
      {"unwrapped_distance_m",
       "m",
       "distance from all frequencies together; only with \"unwrap_range_m\"",
       &Measurement::unwrapped_distance_m,
       {Area::unwrapped, 0},
       Preview{"unwrapped distance", Scale::sequential},
       &Measurement::unrounded_unwrapped_distance_m},
      {"unwrap_ok",
       "",
       "1 where the phases agree on that distance and on no other, else 0; likewise",
       &Measurement::unwrap_ok,
       {Area::unwrapped, 1}},
      {"triangle_id",
       "",
       "of the sample nearest the pixel's centre; 4294967295 where it hits nothing",
       &Measurement::triangle_id,
       {Area::truth, 2}},
      {"object_id",
       "",
       "of the same sample; 4294967295 where it hits nothing",
       &Measurement::object_id,
       {Area::truth, 3},
       Preview{"object", Scale::category}},
      {"normal_x",
       "",
       "x of the normal there, in the camera's frame, turned to the lens; NaN where nothing is hit; only on "
       "demand",
       &Measurement::normal_x,
       {Area::view, 0},
       std::nullopt,
       &Measurement::unrounded_normal_x},
      {"normal_y",
       "",
       "y of the normal there, in the camera's frame, turned to the lens; NaN where nothing is hit; only on "
       "demand",
       &Measurement::normal_y,
       {Area::view, 1},
       std::nullopt,
       &Measurement::unrounded_normal_y},
      {"normal_z",
       "",
       "z of the normal there, in the camera's frame, turned to the lens; NaN where nothing is hit; only on "
       "demand",
       &Measurement::normal_z,
       {Area::view, 2},
       std::nullopt,
       &Measurement::unrounded_normal_z},
      {"ray_x",
       "",
       "x of the unit vector from the lens through the pixel's centre, in the camera's frame; NaN where "
       "there is none; only on demand",
       &Measurement::ray_x,
       {Area::view, 3},
       std::nullopt,
       &Measurement::unrounded_ray_x},
      {"ray_y",
       "",
       "y of the unit vector from the lens through the pixel's centre, in the camera's frame; NaN where "
       "there is none; only on demand",
       &Measurement::ray_y,
       {Area::view, 4},
       std::nullopt,
       &Measurement::unrounded_ray_y},
      {"ray_z",
       "",
       "z of the unit vector from the lens through the pixel's centre, in the camera's frame; NaN where "
       "there is none; only on demand",
       &Measurement::ray_z,
       {Area::view, 5},
       std::nullopt,
       &Measurement::unrounded_ray_z},
  });
}();

constexpr bool is_of_taps(const ChannelRow &row) {
  return std::holds_alternative<std::vector<std::vector<float>> Return::*>(row.at);
}
constexpr bool is_of_frequency(const ChannelRow &row) {
  return std::holds_alternative<std::vector<float> Return::*>(row.at) ||
         std::holds_alternative<std::vector<std::uint32_t> Return::*>(row.at) || is_of_taps(row);
}

// Whether a channel is there only where it is asked for by name.
constexpr bool is_on_demand(const ChannelRow &row) { return row.slot.area == DeviceSlot::Area::view; }

constexpr const ChannelRow &row_of(const ChannelMember &at) {
  return *std::ranges::find(channel_rows, at, &ChannelRow::at);
}

// Which channel of a frame: `frequency` and `tap` are 0 where the row is not of them.
struct ChannelIndex {
  const ChannelRow &row;
  std::size_t frequency = 0, tap = 0;
};

// Calls visit(row, member) for each row whose channels lie in `owner`, a frame or what a frequency returns.
template <class Owner, class Visit>
void for_each_row_of(Owner &owner, Visit visit) {
  for (const ChannelRow &row : channel_rows)
    std::visit(
        [&](auto at) {
          if constexpr (std::is_invocable_v<decltype(at), Owner &>)
            visit(row, owner.*at);
        },
        row.at);
}

// Calls visit(ChannelIndex, values) for each channel that `frame` has room for, in the order of files: each
// frequency's, each frequency's taps, then the frame's. Values of absent channels are empty.
template <class Frame, class Visit>
void for_each_channel(Frame &frame, Visit visit) {
  for (const bool taps : {false, true})
    for (std::size_t f = 0; f < frame.returns.size(); ++f)
      for_each_row_of(frame.returns[f], [&](const ChannelRow &row, auto &member) {
        if (is_of_taps(row) != taps)
          return;
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(member)>, std::vector<std::vector<float>>>)
          for (std::size_t k = 0; k < member.size(); ++k)
            visit(ChannelIndex{row, f, k}, member[k]);
        else
          visit(ChannelIndex{row, f}, member);
      });
  for_each_row_of(frame, [&](const ChannelRow &row, auto &member) { visit(ChannelIndex{row}, member); });
}

// Calls visit(ChannelIndex, values, unrounded) for each channel that may be there in double, too, and that
// `frame` has room for, in that order.
template <class Frame, class Visit>
void for_each_unrounded(Frame &frame, Visit visit) {
  const auto visit_row = [&](auto &owner, const ChannelRow &row, std::size_t f, auto &values) {
    std::visit(
        [&](auto at) {
          constexpr bool is_of_owner = std::is_invocable_v<decltype(at), decltype(owner)>;
          if constexpr (is_of_owner &&
                        std::is_same_v<std::remove_cvref_t<decltype(values)>, std::vector<float>>)
            visit(ChannelIndex{row, f}, values, owner.*at);
        },
        row.unrounded);
  };
  for (std::size_t f = 0; f < frame.returns.size(); ++f)
    for_each_row_of(frame.returns[f], [&](const ChannelRow &row, auto &values) {
      visit_row(frame.returns[f], row, f, values);
    });
  for_each_row_of(frame, [&](const ChannelRow &row, auto &values) { visit_row(frame, row, 0, values); });
}

} // namespace pmdsim
