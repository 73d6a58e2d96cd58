#include "host/output/page/channel_words.h"

#include "engine/correction/corrected_channels.h"
#include "engine/model/channel_names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr std::string_view deformation = "deformation_mm";
constexpr const char *measured = "Measured", *corrected = "Corrected", *errors = "Error and noise",
                     *multipath = "Light that bounces", *truth = "Ground truth",
                     *raw = "The camera's single images", *more = "More";

struct Row {
  std::string_view name, title;
  const char *group;
};

// In the order of lists.
constexpr auto rows = std::to_array<Row>({
    {deformation, "deformation", measured},
    {"distance_m", "distance", measured},
    {"amplitude", "amplitude", measured},
    {"phase_rad", "phase", measured},
    {"unwrapped_distance_m", "unwrapped distance", measured},
    {"unwrap_ok", "unwrapping agrees", measured},
    {"confidence", "confidence", errors},
    {"distance_noise_m", "distance noise", errors},
    {"saturated", "full taps", errors},
    {"error_bound_m", "largest error of the distance", errors},
    {"amplitude_noiseless", "amplitude without noise", errors},
    {"phase_rad_noiseless", "phase without noise", errors},
    {"distance_m_noiseless", "distance without noise", errors},
    {"multipath_m", "multipath", multipath},
    {"multipath_error_m", "error of multipath", multipath},
    {"indirect_share", "indirect share", multipath},
    {"direct_amplitude", "amplitude without bounces", multipath},
    {"direct_phase_rad", "phase without bounces", multipath},
    {"direct_distance_m", "distance without bounces", multipath},
    {"range_m", "true distance", truth},
    {"z_m", "true depth", truth},
    {"coverage", "coverage", truth},
    {"lit", "lit", truth},
    {"mean_radiance", "mean radiance", truth},
    {"object_id", "object", truth},
    {"triangle_id", "triangle", truth},
    {"normal_x", "normal, x", truth},
    {"normal_y", "normal, y", truth},
    {"normal_z", "normal, z", truth},
    {"ray_x", "ray, x", truth},
    {"ray_y", "ray, y", truth},
    {"ray_z", "ray, z", truth},
    {"tap", "tap", raw},
    {"tap_a_e", "electrons of tap A, image", raw},
    {"tap_b_e", "electrons of tap B, image", raw},
    {"tap_a_dn", "numbers of tap A, image", raw},
    {"tap_b_dn", "numbers of tap B, image", raw},
});

constexpr auto corrected_titles = std::to_array<Row>({
    {"range_m", "corrected range", corrected},
    {"x_m", "corrected point, x", corrected},
    {"y_m", "corrected point, y", corrected},
    {"z_m", "corrected point, z", corrected},
    {"correction_mm", "correction", corrected},
    {"normal_error_mm", "error by the normal", errors},
    {"status", "status", corrected},
});

// Several frequencies' channels of one kind stand together.
constexpr std::size_t places_of_row = 32;

PageScale scale_of(std::string_view name, const ChannelRow *row, bool is_integer) {
  if (row && row->preview)
    return static_cast<PageScale>(row->preview->scale); // ColourScale's come first, in its order
  if (is_integer)
    return name == "saturated" ? PageScale::bits : name == "unwrap_ok" ? PageScale::share : PageScale::ids;
  if (name.find("phase_rad") != std::string_view::npos)
    return PageScale::turn;
  if (name == deformation || name.starts_with("normal_") || name.starts_with("ray_"))
    return PageScale::zero_centred;
  return name == "coverage" ? PageScale::share : PageScale::sequential;
}

ChannelRank rank_of(std::string_view name, std::string_view group) {
  if (group == raw)
    return ChannelRank::raw;
  const bool is_secondary = name.ends_with("_noiseless") || name.starts_with("direct_") ||
                            name.starts_with("normal_") || name.starts_with("ray_") ||
                            name == "mean_radiance" || name == "triangle_id" || name == "phase_rad";
  return is_secondary ? ChannelRank::secondary : ChannelRank::main;
}

std::string_view none_of(std::string_view group) {
  if (group == truth)
    return "nothing hit";
  return group == more ? "no value" : "no return";
}

// A name without its frequency, "f1.".
std::pair<std::optional<std::size_t>, std::string_view> without_frequency(std::string_view name) {
  std::size_t frequency = 0;
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos || dot < 2 || dot > 4 || name.front() != 'f')
    return {std::nullopt, name};
  const auto [end, error] = std::from_chars(name.data() + 1, name.data() + dot, frequency);
  if (error != std::errc() || end != name.data() + dot)
    return {std::nullopt, name};
  return {frequency, name.substr(dot + 1)};
}

} // namespace

ChannelWords words_of(std::string_view channel_name, bool is_integer) {
  const ChannelName known = channel_named(channel_name);
  const auto [frequency, quantity] = without_frequency(channel_name);
  const std::string_view name = known.row ? known.row->name : quantity;
  const auto row = std::ranges::find(rows, name, &Row::name);
  const bool has_row = row != rows.end();
  const std::string group = has_row ? row->group : more;
  const std::string tap = known.tap ? fmt::format(" {}", *known.tap) : "";
  const std::string about = known.row             ? std::string(known.row->about)
                            : name == deformation ? "bistatic minus monostatic distance, wrapped"
                                                  : "";
  return {std::string(quantity),
          frequency,
          std::string(has_row ? row->title : quantity) + tap,
          group,
          about,
          std::string(none_of(group)),
          scale_of(name, known.row, is_integer),
          rank_of(name, group),
          static_cast<std::size_t>(row - rows.begin()) * places_of_row + known.tap.value_or(0)};
}

ChannelWords corrected_words_of(std::string_view channel_name, bool is_integer) {
  const auto row = std::ranges::find(corrected_channel_rows, channel_name, &CorrectedChannelRow::name);
  ChannelWords words = words_of(channel_name, is_integer);
  if (row == corrected_channel_rows.end())
    return words;
  const auto named = std::ranges::find(corrected_titles, channel_name, &Row::name);
  words.title = named == corrected_titles.end() ? channel_name : named->title;
  words.group = named == corrected_titles.end() ? more : named->group;
  words.about = row->about;
  words.none = "not corrected";
  words.at = static_cast<std::size_t>(row - corrected_channel_rows.begin());
  return words;
}

std::string_view scale_name(PageScale scale) {
  constexpr std::array<std::string_view, 6> names{"sequential", "zero_centred", "turn",
                                                  "share",      "ids",          "bits"};
  return names.at(static_cast<std::size_t>(scale));
}

} // namespace pmdsim
