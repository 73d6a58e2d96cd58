#include "host/output/run/frame_records.h"

#include "engine/model/error.h"
#include "host/input/file/input_file.h"
#include "host/input/words/folder_names.h"
#include "host/output/run/run_identity.h"
#include "host/output/run/run_json.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <fmt/format.h>
#include <set>
#include <string_view>
#include <sys/stat.h>
#include <system_error>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::string_view record_ending = ".record.json";

std::optional<std::uint32_t> frame_of(std::string_view name) {
  std::uint32_t frame = 0;
  if (!name.ends_with(record_ending))
    return std::nullopt;
  const std::string_view number = name.substr(0, name.size() - record_ending.size());
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), frame);
  return error == std::errc() && name == record_name(frame) ? std::optional(frame) : std::nullopt;
}

ordered_json sensor_json(const FrameRecord &part) {
  ordered_json json{{"manifest", frame_json(part)},
                    {"frame_ms", part.frame_ms},
                    {"passes_ms", passes_json(part.passes)},
                    {"check_ms", part.accuracy.check_ms},
                    {"bytes", array_of(part.outputs, [](const NamedFile &file) { return file.bytes; })}};
  if (!part.told.is_null())
    json["told"] = part.told;
  if (!part.thumbnails.is_null())
    json["thumbnails"] = part.thumbnails;
  return json;
}

using Array = ordered_json::array_t;

// "NAME_0007.exr" of frame 7: in the folder, not hidden, and none of the run's own files.
bool is_name_of_frame(const std::string &name, std::uint32_t frame) {
  return is_plain_name(name) && name.find(fmt::format("_{:04}.", frame)) != std::string::npos;
}

// Each is brought by itself, so that a file that is named twice would be there twice.
bool are_different(const Array &sensors) {
  std::set<std::string_view> names;
  for (const ordered_json &sensor : sensors)
    for (const ordered_json &name : sensor.at("manifest").at("outputs"))
      if (!names.insert(name.get_ref<const std::string &>()).second)
        return false;
  return true;
}

// The three that follow: whether it looks as record_json() makes it, or json::exception.
bool has_warnings_form(const ordered_json &entry) {
  for (const ordered_json &warning : entry.value("warnings", ordered_json::array()))
    warning_of(warning);
  return true;
}

bool entry_has_its_form(const ordered_json &entry, std::uint32_t frame) {
  const auto is_name = [&](const ordered_json &name) {
    return is_name_of_frame(name.get_ref<const std::string &>(), frame);
  };
  return entry.at("sensor").is_string() && entry.at("frame") == frame && entry.at("time_s").is_number() &&
         entry.at("mode").is_string() && entry.at("unpromised").is_number_unsigned() &&
         entry.contains("error_claimed_m") && has_warnings_form(entry) &&
         std::ranges::all_of(entry.at("outputs").get_ref<const Array &>(), is_name);
}

bool sensor_has_its_form(const ordered_json &sensor, std::uint32_t frame) {
  const auto is_size = [](const ordered_json &bytes) { return bytes.is_number_unsigned(); };
  const auto &bytes = sensor.at("bytes").get_ref<const Array &>();
  const auto has = [&](const char *key) { return sensor.contains(key); };
  return entry_has_its_form(sensor.at("manifest"), frame) &&
         bytes.size() == sensor.at("manifest").at("outputs").size() && std::ranges::all_of(bytes, is_size) &&
         std::ranges::all_of(std::array{"frame_ms", "passes_ms", "check_ms"}, has) &&
         (!has("told") || sensor.at("told").is_object());
}

bool has_its_form(const ordered_json &record, std::uint32_t frame) {
  const auto &sensors = record.at("sensors").get_ref<const Array &>();
  return record.at("frame") == frame && !sensors.empty() &&
         std::ranges::all_of(sensors,
                             [&](const ordered_json &each) { return sensor_has_its_form(each, frame); }) &&
         are_different(sensors);
}

// Nothing where there is no such file. It may go, or come, at any time.
std::optional<std::string> text_of(const fs::path &file) {
  std::error_code ignored;
  if (fs::status(file, ignored).type() == fs::file_type::not_found)
    return std::nullopt;
  try {
    return read_regular_file(file, max_run_json_bytes, Place{file});
  } catch (const Error &) {
    if (fs::status(file, ignored).type() == fs::file_type::not_found)
      return std::nullopt;
    throw;
  }
}

Error unreadable(const fs::path &path, const std::error_code &error) {
  return {ExitCode::output, fmt::format("{}: cannot be read: {}", path.string(), error.message())};
}

// A link is no frame's file, as what it leads to need not be one either.
bool is_file_of(const fs::path &path, std::uint64_t bytes) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0)
    return S_ISREG(status.st_mode) && static_cast<std::uint64_t>(status.st_size) == bytes;
  if (errno != ENOENT && errno != ENOTDIR)
    throw unreadable(path, std::error_code(errno, std::generic_category()));
  return false;
}

} // namespace

std::string record_name(std::uint32_t frame) { return fmt::format("{:04}{}", frame, record_ending); }

ordered_json record_json(const std::string &run_hash, const std::vector<FrameRecord> &parts) {
  static const std::string host = this_process().host;
  return {{"frame", parts.front().frame},
          {"run", run_hash},
          {"host", host},
          {"sensors", array_of(parts, sensor_json)}};
}

std::optional<ordered_json> read_record(const fs::path &folder, std::uint32_t frame,
                                        const std::string &run_hash) {
  const fs::path file = folder / record_name(frame);
  const std::optional<std::string> text = text_of(file);
  auto record = text ? parsed_in_order(*text, file) : std::nullopt; // a power cut may leave half of it
  try {
    if (record && record->at("run") == run_hash && has_its_form(*record, frame))
      return record;
    return std::nullopt;
  } catch (const nlohmann::json::exception &) { // it is not what was written
    return std::nullopt;
  }
}

bool has_its_files(const fs::path &folder, const ordered_json &record) {
  for (const ordered_json &sensor : record.at("sensors")) {
    const ordered_json &outputs = sensor.at("manifest").at("outputs");
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const auto bytes = sensor.at("bytes").at(i).get<std::uint64_t>();
      if (!is_file_of(folder / outputs[i].get<std::string>(), bytes))
        return false;
    }
  }
  return true;
}

bool has_warnings(const ordered_json &record) {
  const auto any = [](const ordered_json &of) {
    const auto pixels = of.find("unpromised");
    return (pixels != of.end() && *pixels != 0) || of.contains("warnings");
  };
  return std::ranges::any_of(record.at("sensors"), [&](const ordered_json &sensor) {
    return any(sensor.at("manifest")) || (sensor.contains("told") && any(sensor.at("told")));
  });
}

std::vector<std::uint32_t> recorded_frames(const fs::path &folder) {
  std::vector<std::uint32_t> frames;
  std::error_code error;
  for (const std::string &name : names_in(folder, error))
    if (const auto frame = frame_of(name))
      frames.push_back(*frame);
  if (error)
    throw unreadable(folder, error);
  std::ranges::sort(frames);
  return frames;
}

ordered_json told_json(const ordered_json &of_sensor) {
  const ordered_json &entry = of_sensor.at("manifest");
  ordered_json json;
  for (const char *key : {"sensor", "frame", "time_s"})
    json[key] = entry.at(key);
  json["frame_ms"] = of_sensor.at("frame_ms");
  json["passes_ms"] = of_sensor.at("passes_ms");
  for (auto key = entry.find("mode"); key != entry.end(); ++key)
    if (key.key() != "bounces" && key.key() != "outputs")
      json[key.key()] = key.value();
  json["check_ms"] = of_sensor.at("check_ms");
  if (entry.contains("bounces"))
    json["bounces"] = entry.at("bounces");
  return json;
}

} // namespace pmdsim
