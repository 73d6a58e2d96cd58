#include "host/input/schema/hints.h"

#include "host/input/file/input_error.h"
#include "host/input/words/near_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <optional>
#include <utility>

namespace pmdsim {

using nlohmann::json;

namespace {

using Meaning = std::pair<std::string_view, std::string_view>;

// Keys that other programs have, and ours.
constexpr std::array<Meaning, 58> keys_meant{{
    {"frequency", "modulation_hz"},
    {"frequencies", "modulation_hz"},
    {"freq", "modulation_hz"},
    {"modulation_frequency", "modulation_hz"},
    {"modulation_frequencies", "modulation_hz"},
    {"width", "resolution"},
    {"height", "resolution"},
    {"columns", "resolution"},
    {"rows", "resolution"},
    {"image_size", "resolution"},
    {"size", "resolution"},
    {"fov", "focal_length_m"},
    {"fov_deg", "focal_length_m"},
    {"field_of_view", "focal_length_m"},
    {"field_of_view_deg", "focal_length_m"},
    {"f", "focal_length_m"},
    {"focal", "focal_length_m"},
    {"pixel_size", "pixel_pitch_m"},
    {"pitch", "pixel_pitch_m"},
    {"spp", "samples"},
    {"phases", "taps"},
    {"fps", "rate_hz"},
    {"frame_rate", "rate_hz"},
    {"framerate", "rate_hz"},
    {"frames", "count"},
    {"number", "count"},
    {"file", "scene"},
    {"mesh", "scene"},
    {"gltf", "scene"},
    {"camera", "sensors"},
    {"cameras", "sensors"},
    {"lights", "illuminators"},
    {"light", "illuminators"},
    {"leds", "diodes"},
    {"position", "position_m"},
    {"target", "look_at_m"},
    {"transform", "matrix"},
    {"power", "intensity_w_sr"},
    {"power_w", "intensity_w_sr"},
    {"radiation", "pattern"},
    {"phase", "modulation_phase_deg"},
    {"nx", "axis_x"},
    {"ny", "axis_y"},
    {"nz", "axis_z"},
    {"dir_x", "axis_x"},
    {"dir_y", "axis_y"},
    {"dir_z", "axis_z"},
    {"direction_x", "axis_x"},
    {"direction_y", "axis_y"},
    {"direction_z", "axis_z"},
    {"ax", "axis_x"},
    {"ay", "axis_y"},
    {"az", "axis_z"},
    {"intensity", "intensity_w_sr"},
    {"i", "intensity_w_sr"},
    {"order", "pattern"},
    {"lambert", "pattern"},
    {"law", "pattern"},
}};

// Values likewise.
constexpr std::array<Meaning, 16> values_meant{{
    {"sinus", "sine"},
    {"sinusoidal", "sine"},
    {"cosine", "sine"},
    {"rectangular", "square"},
    {"rect", "square"},
    {"diffuse", "lambert"},
    {"on", "auto"},
    {"none", "off"},
    {"cos^4", "cos4"},
    {"cosine4", "cos4"},
    {"opencv", "brown"},
    {"plumb_bob", "brown"},
    {"radtan", "brown"},
    {"equidistant", "fisheye"},
    {"kannala_brandt", "fisheye"},
    {"infinite", "all"},
}};

// The unit of a key by its ending, and its name.
constexpr std::array<Meaning, 6> units{{{"_w_sr", "watts per steradian"},
                                        {"_deg", "degrees"},
                                        {"_hz", "hertz"},
                                        {"_m", "metres"},
                                        {"_s", "seconds"},
                                        {"_e", "electrons"}}};
constexpr std::array<std::string_view, 16> other_units{
    "_mm", "_cm", "_um",  "_nm", "_khz", "_mhz",     "_ghz",    "_ms",
    "_us", "_ns", "_rad", "_w",  "_mw",  "_degrees", "_metres", "_meters"};

// What units come to in ours.
constexpr std::array<std::pair<std::string_view, double>, 18> factors{{{"m", 1.0},
                                                                       {"mm", 1e-3},
                                                                       {"cm", 1e-2},
                                                                       {"um", 1e-6},
                                                                       {"nm", 1e-9},
                                                                       {"hz", 1.0},
                                                                       {"khz", 1e3},
                                                                       {"mhz", 1e6},
                                                                       {"ghz", 1e9},
                                                                       {"s", 1.0},
                                                                       {"ms", 1e-3},
                                                                       {"us", 1e-6},
                                                                       {"ns", 1e-9},
                                                                       {"deg", 1.0},
                                                                       {"degrees", 1.0},
                                                                       {"w/sr", 1.0},
                                                                       {"%", 1e-2},
                                                                       {"", 1.0}}};

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

template <std::size_t N>
std::optional<std::string> meant_by(const std::array<Meaning, N> &meanings, std::string_view written,
                                    const std::vector<std::string> &known) {
  const std::string text = lower(written);
  for (const auto &[other, ours] : meanings)
    if (text == other && std::ranges::find(known, ours) != known.end())
      return std::string(ours);
  return std::nullopt;
}

// A key without its unit.
std::string stem_of(std::string_view key) {
  std::string text = lower(key);
  for (const auto &[ending, name] : units)
    if (text.ends_with(ending))
      return text.substr(0, text.size() - ending.size());
  for (const std::string_view ending : other_units)
    if (text.ends_with(ending))
      return text.substr(0, text.size() - ending.size());
  return text;
}

std::string in_unit(std::string_view key) {
  for (const auto &[ending, name] : units)
    if (key.ends_with(ending))
      return fmt::format(", in {}", name);
  return "";
}

std::optional<double> number_with_unit(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !std::isfinite(number))
    return std::nullopt;
  std::string unit = lower(text.substr(static_cast<std::size_t>(end - text.data())));
  unit.erase(0, unit.find_first_not_of(' '));
  for (const auto &[name, factor] : factors)
    if (unit == name)
      return number * factor;
  return std::nullopt;
}

// "640x480", "640 x 480", "640, 480".
std::optional<json> pair_of(std::string_view text) {
  int first = 0, second = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), first);
  std::string_view rest = text.substr(static_cast<std::size_t>(end - text.data()));
  const std::size_t sign = rest.find_first_not_of(' ');
  if (error != std::errc() || sign == rest.npos ||
      std::string_view("xX*,").find(rest[sign]) == std::string_view::npos)
    return std::nullopt;
  rest.remove_prefix(std::min(rest.find_first_not_of(' ', sign + 1), rest.size()));
  const auto [last, failure] = std::from_chars(rest.data(), rest.data() + rest.size(), second);
  return failure == std::errc() && last == rest.data() + rest.size() ? std::optional(json{first, second})
                                                                     : std::nullopt;
}

// Written without a fraction where it has none.
json whole(double number) {
  constexpr double largest_exact = 9007199254740992.0; // 2^53
  return std::abs(number) <= largest_exact && std::trunc(number) == number
             ? json(static_cast<std::int64_t>(number))
             : json(number);
}

// What an array may have been meant by.
std::optional<json> array_meant(const json &schema, const json &value) {
  if (value.is_string()) {
    const auto &text = value.get_ref<const std::string &>();
    if (const auto pair = pair_of(text))
      return pair;
    const auto number = number_with_unit(text);
    return number ? array_meant(schema, whole(*number)) : std::nullopt;
  }
  const json items = schema.value("items", json::object());
  const std::string of = items.is_object() ? items.value("type", "") : "";
  if (of != "number" && of != "integer")
    return std::nullopt;
  const std::size_t least = schema.value("minItems", 0U);
  constexpr std::size_t most_repeated = 4;
  if (!value.is_number() || least > most_repeated || (least > 1 && least != schema.value("maxItems", 0U)))
    return std::nullopt;
  return json(std::max<std::size_t>(least, 1), value);
}

std::string written(const json &value) {
  if (!value.is_array())
    return value.dump();
  std::string text;
  for (const json &element : value)
    text += (text.empty() ? "" : ", ") + element.dump();
  return "[" + text + "]";
}

} // namespace

std::string key_hint(std::string_view written, const std::vector<std::string> &known) {
  if (const auto meant = meant_by(keys_meant, written, known))
    return fmt::format(", did you mean {}{}?", in_quotes(*meant), in_unit(*meant));
  const auto same = std::ranges::find(known, stem_of(written), stem_of);
  if (same != known.end())
    return fmt::format(", expected {}{}", in_quotes(*same), in_unit(*same));
  return did_you_mean(written, known);
}

std::string text_hint(std::string_view written, const std::vector<std::string> &known) {
  if (const auto meant = meant_by(values_meant, written, known))
    return fmt::format(", did you mean {}?", in_quotes(*meant));
  return did_you_mean(written, known);
}

std::string value_hint(const json &schema, const json &value) {
  const std::string type = schema.value("type", "");
  std::optional<json> meant;
  if (type == "array")
    meant = array_meant(schema, value);
  if ((type == "number" || type == "integer") && value.is_string())
    if (const auto number = number_with_unit(value.get_ref<const std::string &>()))
      meant = whole(*number);
  if (type == "boolean" && (value == "true" || value == "false"))
    meant = value == "true";
  if (type == "boolean" && value.is_number())
    meant = value != 0;
  if (meant)
    return "; write " + written(*meant);
  return type == "array" && value.is_object() ? "; write [{...}]" : "";
}

} // namespace pmdsim
