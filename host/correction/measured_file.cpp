#include "host/correction/measured_file.h"

#include "engine/lens/lens.h"
#include "engine/model/error.h"
#include "engine/signal/unwrapping.h"
#include "host/input/array/image_array.h"
#include "host/input/file/input_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

namespace pmdsim {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::string with_frequency(const Sensor &sensor, std::size_t frequency, const std::string &name) {
  return sensor.modulation_hz.size() > 1 ? fmt::format("f{}.{}", frequency, name) : name;
}

// The names that the image may have, the first that is there counts.
std::vector<std::string> names_of_image(const ImageRequest &request, const Sensor &sensor) {
  if (request.channel)
    return {*request.channel, with_frequency(sensor, request.frequency, *request.channel)};
  return {with_frequency(sensor, request.frequency, "distance_m"),
          with_frequency(sensor, request.frequency, "phase_rad")};
}

const ImageArray *find_array(const ImageArrays &read, std::string_view name) {
  const auto found = std::ranges::find(read.arrays, name, &ImageArray::name);
  return found == read.arrays.end() ? nullptr : &*found;
}

void require_size(const ImageArray &array, const Sensor &sensor, const std::filesystem::path &file) {
  if (array.resolution != sensor.resolution)
    throw input_error(Place{file},
                      fmt::format("expected {} x {} pixels (columns x rows) as sensor {} has, "
                                  "found {} x {}",
                                  sensor.resolution.x, sensor.resolution.y, in_quotes(sensor.name),
                                  array.resolution.x, array.resolution.y));
}

// A file of `render` in its directory, of the formats that hold numbers.
std::filesystem::path file_in(const ImageRequest &request, const Sensor &sensor, std::uint32_t frame) {
  const std::string stem = fmt::format("{}_{:04}", sensor.name, frame);
  std::vector<std::string> names{stem + ".h5", stem + ".exr", stem + ".npz"};
  for (const std::string &name : names_of_image(request, sensor))
    names.push_back(fmt::format("{}.{}.npy", stem, name));
  for (const std::string &name : names) {
    const std::filesystem::path file = request.file / name;
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::symlink_status(file, ignored);
    if (std::filesystem::is_symlink(status)) // to whatever it leads
      throw input_error(Place{file}, "is a link, expected a file");
    if (std::filesystem::exists(status))
      return file;
  }
  throw input_error(Place{request.file},
                    fmt::format("expected one of {} in the directory", fmt::join(names, ", ")));
}

const ImageArray &image_of(const ImageArrays &read, const ImageRequest &request, const Sensor &sensor,
                           const std::filesystem::path &file) {
  if (read.names.empty() && request.channel)
    throw Error(ExitCode::usage,
                fmt::format("--channel: {} holds a single image, which has no name", file.string()));
  if (read.names.empty())
    return read.arrays.front();
  const std::vector<std::string> names = names_of_image(request, sensor);
  for (const std::string &name : names)
    if (const ImageArray *array = find_array(read, name))
      return *array;
  throw input_error(Place{file}, fmt::format("expected the channel {}, found {}{}", fmt::join(names, " or "),
                                             fmt::join(read.names, ", "),
                                             request.channel ? "" : "; --channel names another"));
}

void depths_to_distances(std::vector<double> &values, const Sensor &sensor) {
  const Lens lens(sensor);
  for (std::uint32_t row = 0; row < sensor.resolution.y; ++row)
    for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
      const auto ray = lens.ray(lens.on_chip_m({column + 0.5, row + 0.5}));
      values[std::size_t{row} * sensor.resolution.x + column] /= ray && ray->z > 0.0 ? ray->z : not_a_number;
    }
}

// By the distances of all frequencies in the file.
std::vector<double> unwrapped_m(const ImageArrays &read, const ImageRequest &request, Sensor sensor,
                                const std::filesystem::path &file) {
  sensor.unwrap_range_m = request.unwrap_range_m;
  sensor.electronics.reset();
  Measurement frame;
  frame.resolution = sensor.resolution;
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i) {
    const std::string name = with_frequency(sensor, i, "distance_m");
    const ImageArray *array = find_array(read, name);
    if (!array)
      throw input_error(Place{file}, fmt::format("--unwrap: expected the channel {}", name));
    require_size(*array, sensor, file);
    Return &of_frequency = frame.returns.emplace_back();
    of_frequency.distance_m.assign(array->values.begin(), array->values.end());
    of_frequency.amplitude.assign(array->values.size(), 1.0f);
  }
  unwrap_distances(sensor, frame);
  return {frame.unwrapped_distance_m.begin(), frame.unwrapped_distance_m.end()};
}

// By distances that are unwrapped already, where more of them than stray ones lie beyond the ambiguity range,
// by more than a step of the image.
void find_turns_of_distances(const std::vector<double> &distance_m, double ambiguity_m,
                             MeasuredFile &measured) {
  constexpr double most_stray = 0.01, rounding = 1e-6;
  const double end_m = ambiguity_m * (1.0 + rounding) + 0.5 * measured.image.step_m;
  const auto all = std::ranges::count_if(distance_m, [](double d) { return std::isfinite(d); });
  const auto beyond = std::ranges::count_if(distance_m, [&](double d) { return d > end_m; });
  const double share = all > 0 ? static_cast<double>(beyond) / static_cast<double>(all) : 0.0;
  if (share <= most_stray) {
    measured.beyond_ambiguity = static_cast<std::size_t>(beyond);
    return;
  }
  measured.image.guess_m = distance_m;
  measured.turns = fmt::format("the distances themselves, {:.1f} % of which are beyond the ambiguity range",
                               100.0 * share);
}

// What tells the turns, in the order of preference. `distance_m` is empty where the image has phases.
void find_turns(const ImageArrays &read, const ImageRequest &request, const Sensor &sensor,
                const std::filesystem::path &file, const std::vector<double> &distance_m,
                MeasuredFile &measured) {
  std::vector<double> &guess_m = measured.image.guess_m;
  if (!request.guess.empty()) {
    guess_m = read_truth(request.guess, sensor).range_m;
    measured.turns = request.guess.string();
  } else if (request.unwrap_range_m > 0.0) {
    guess_m = unwrapped_m(read, request, sensor, file);
    measured.turns = "the distances of all frequencies";
  } else if (request.least_range_m) {
    return;
  } else if (const ImageArray *array = find_array(read, "unwrapped_distance_m")) {
    require_size(*array, sensor, file);
    guess_m = array->values;
    measured.turns = "unwrapped_distance_m of the same file";
  } else {
    find_turns_of_distances(distance_m, sensor.ambiguity_m(request.frequency), measured);
  }
}

bool is_of_truth(std::string_view name) { return name == "range_m" || name == "lit"; }

// The values of a channel that may be missing.
std::vector<double> channel_of(const ImageArrays &read, const char *name, const Sensor &sensor,
                               const std::filesystem::path &file) {
  const ImageArray *array = find_array(read, name);
  if (!array)
    return {};
  require_size(*array, sensor, file);
  return array->values;
}

// The phases of the values that were read, and their turns.
void take_values(const ImageArray &array, const ImageArrays &read, const ImageRequest &request,
                 const Sensor &sensor, const std::filesystem::path &file, MeasuredFile &measured) {
  const double modulation_hz = sensor.modulation_hz[request.frequency];
  const Meaning &meaning = measured.meaning;
  const bool is_phase = meaning.quantity == Quantity::phase;
  std::vector<double> values = measured.values;
  if (array.whole_numbers)
    measured.image.step_m = is_phase ? distance_of_phase_m(meaning.unit, modulation_hz) : meaning.unit;
  if (meaning.quantity == Quantity::depth)
    depths_to_distances(values, sensor);
  find_turns(read, request, sensor, file, is_phase ? std::vector<double>{} : values, measured);
  if (!is_phase) {
    measured.warnings = doubts_of_distances(values, sensor.ambiguity_m(request.frequency), measured.source);
    for (double &value : values)
      value = phase_of_distance_rad(value, modulation_hz);
  }
  measured.image.phase_rad = std::move(values);
}

} // namespace

MeasuredFile read_measured(const ImageRequest &request, const Sensor &sensor, std::uint32_t frame) {
  if (request.unwrap_range_m > 0.0 && sensor.modulation_hz.size() < 2)
    throw Error(ExitCode::usage,
                fmt::format("--unwrap: expected at least two frequencies, sensor {} has one", sensor.name));
  const std::filesystem::path file =
      std::filesystem::is_directory(request.file) ? file_in(request, sensor, frame) : request.file;
  const std::vector<std::string> names = names_of_image(request, sensor);
  const ImageArrays read = read_image_arrays(file, [&](std::string_view name) {
    return is_of_truth(name) || name == "unwrapped_distance_m" ||
           std::ranges::find(names, name) != names.end() ||
           (request.unwrap_range_m > 0.0 && name.ends_with(".distance_m"));
  });
  const ImageArray &array = image_of(read, request, sensor, file);
  require_size(array, sensor, file);
  const std::string name = array.name.empty() ? file.filename().string() : array.name;
  MeasuredFile measured{.source = array.name.empty() ? file.string()
                                                     : fmt::format("{} of {}", array.name, file.string()),
                        .meaning = meaning_of(name, array.whole_numbers, request.quantity, request.unit)};
  measured.values = values_of(array, measured.meaning, request.invalid);
  take_values(array, read, request, sensor, file, measured);
  measured.range_m = channel_of(read, "range_m", sensor, file);
  measured.lit = channel_of(read, "lit", sensor, file);
  return measured;
}

TruthFile read_truth(const std::filesystem::path &file, const Sensor &sensor) {
  const ImageArrays read = read_image_arrays(file, is_of_truth);
  TruthFile truth;
  if (read.names.empty()) {
    require_size(read.arrays.front(), sensor, file);
    const ImageArray &array = read.arrays.front();
    truth.range_m = values_of(array, {Quantity::distance, array.whole_numbers ? 1e-3 : 1.0}, {});
    return truth;
  }
  truth.range_m = channel_of(read, "range_m", sensor, file);
  if (truth.range_m.empty())
    throw input_error(Place{file},
                      fmt::format("expected the channel range_m, found {}", fmt::join(read.names, ", ")));
  truth.lit = channel_of(read, "lit", sensor, file);
  return truth;
}

} // namespace pmdsim
