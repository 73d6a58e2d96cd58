#include "host/command_line/correct_options.h"

#include "engine/model/error.h"
#include "host/input/file/input_error.h"
#include "host/input/file/length.h"
#include "host/input/words/near_name.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <fmt/format.h>
#include <map>
#include <numbers>

namespace pmdsim {
namespace {

constexpr std::uint32_t most_fit_pixels = 16;

double length_of(const char *option, const std::string &text) {
  if (const auto length = length_m(text))
    return *length;
  throw Error(ExitCode::usage,
              fmt::format("{}: expected a length with its unit, m, mm or um, e.g. 7.5m, found {}", option,
                          in_quotes(text)));
}

// Of a kind that people ask for, where it is none of an image to correct.
void take_quantity(const std::string &quantity, ImageRequest &image) {
  static const std::map<std::string, Quantity> quantities{
      {"distance", Quantity::distance}, {"phase", Quantity::phase}, {"depth", Quantity::depth}};
  if (const auto named = quantities.find(quantity); named != quantities.end()) {
    image.quantity = named->second;
    return;
  }
  std::vector<std::string> names;
  for (const auto &named : quantities)
    names.push_back(named.first);
  throw Error(ExitCode::usage,
              fmt::format("--quantity: expected distance, phase or depth, found {}{}", in_quotes(quantity),
                          quantity == "range" || quantity == "range_m"
                              ? "; ranges from the lens are what correct finds, --truth and --guess take them"
                              : did_you_mean(quantity, names)));
}

// A unit says whether the image holds angles or lengths, unless that is said already.
void take_unit(const std::string &unit, ImageRequest &image) {
  // Metres or radians of 1.
  static const std::map<std::string, double> lengths{{"m", 1.0}, {"mm", 1e-3}},
      angles{{"rad", 1.0}, {"turns", 2.0 * std::numbers::pi}};
  const bool is_angle = angles.contains(unit);
  const auto named = lengths.find(unit);
  const std::optional<double> length = named != lengths.end() ? named->second : length_m(unit);
  if (!is_angle && !length)
    throw Error(ExitCode::usage,
                fmt::format("--unit: expected m, mm, a length such as 0.1mm, rad or turns, found {}",
                            in_quotes(unit)));
  if (image.quantity && (*image.quantity == Quantity::phase) != is_angle)
    throw Error(ExitCode::usage,
                fmt::format("--unit {}: expected {}", unit,
                            is_angle ? "m or mm, for a distance or depth" : "rad or turns, for a phase"));
  if (is_angle)
    image.quantity = Quantity::phase;
  image.unit = is_angle ? angles.at(unit) : *length;
}

// A length in place of an image is for another option.
void check_guess(const std::filesystem::path &guess) {
  std::error_code ignored;
  if (length_m(guess.string()) && !std::filesystem::exists(guess, ignored))
    throw Error(
        ExitCode::usage,
        fmt::format("--guess: expected an image of ranges, found the length {}; --least-range takes a "
                    "length",
                    in_quotes(guess.string())));
}

void take_normals(const std::string &text, CorrectOptions &options) {
  if (text == "facing") {
    options.normals = NormalsFrom::facing;
    return;
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), options.fit_pixels);
  if (error != std::errc() || end != text.data() + text.size() || options.fit_pixels < 1 ||
      options.fit_pixels > most_fit_pixels)
    throw Error(ExitCode::usage, fmt::format("--normals: expected facing, or how many pixels to each side a "
                                             "plane is fitted to, 1 to {}, found {}",
                                             most_fit_pixels, in_quotes(text)));
}

} // namespace

void add_correct(CLI::App &command, WrittenCorrect &written) {
  CorrectOptions &options = written.options;
  command
      .add_option(
          "IMAGE", options.image.file,
          "the measured image: NPY, NPZ, EXR, HDF5, PNG (16 bit, grey) or rows of numbers as text; or "
          "the directory that `pmdsim render` left")
      ->required();
  command.add_option("--channel", options.image.channel,
                     "of a file with several [distance_m, else phase_rad]");
  command.add_option(
      "--quantity", written.quantity,
      "what the image holds: distance, phase, or depth along the optical axis [by its name, else "
      "distance]");
  command.add_option(
      "--unit", written.unit,
      "of the image: m, mm, a length such as 0.1mm, rad or turns [by its name, else m, of whole "
      "numbers mm; rad]");
  command.add_option("--invalid", options.image.invalid,
                     "a number of the file that says: not measured [NaN, infinity, the largest number of an "
                     "unsigned integer type, and 0 or less but of a phase, say so anyway]");
  command.add_option("--sensor", options.sensor, "the sensor's name, of several [the first]");
  command.add_option("--frame", options.frame,
                     "the image's frame, of a setup that moves, and in a directory of frames [0]");
  command.add_option("--frequency", options.image.frequency,
                     "the index of the image's modulation frequency, of several [0]");
  command.add_option(
      "--least-range", written.least_range,
      "ranges lie between this and one ambiguity range more, e.g. 7.5m [0; else what the image "
      "tells of turns]");
  command.add_option("--guess", options.image.guess,
                     "an image of ranges, each right within half of the ambiguity range");
  command.add_option("--unwrap", written.unwrap,
                     "the distances of all frequencies in the image tell the turn, within so much, e.g. 15m");
  command.add_option("--normals", written.normals,
                     "facing: surfaces face the lens; or N: planes are fitted to N pixels to each side, 1 to "
                     "16 [by the noise that is found]");
  command.add_option(
      "--truth", options.truth,
      "the true ranges, an image or `scene`, the setup's: tells what error remains [range_m of "
      "IMAGE, if it is there]");
}

CorrectOptions correct_options_of(const WrittenCorrect &written) {
  CorrectOptions options = written.options;
  if (written.quantity)
    take_quantity(*written.quantity, options.image);
  if (written.unit)
    take_unit(*written.unit, options.image);
  if (written.least_range)
    options.image.least_range_m =
        *written.least_range == "0" ? 0.0 : length_of("--least-range", *written.least_range);
  if (written.unwrap)
    options.image.unwrap_range_m = length_of("--unwrap", *written.unwrap);
  check_guess(options.image.guess);
  if (written.normals)
    take_normals(*written.normals, options);
  return options;
}

} // namespace pmdsim
