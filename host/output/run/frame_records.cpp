#include "host/output/run/frame_records.h"

#include "engine/model/error.h"
#include "host/output/run/run_identity.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
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
  return json;
}

// Whether it looks as record_json() makes it, or json::exception. Names stay within the folder.
bool has_its_form(const ordered_json &record) {
  for (const ordered_json &sensor : record.at("sensors")) {
    const auto &outputs = sensor.at("manifest").at("outputs").get_ref<const ordered_json::array_t &>();
    for (const ordered_json &name : outputs)
      if (name.get_ref<const std::string &>().find('/') != std::string::npos)
        return false;
    const auto is_size = [](const ordered_json &bytes) { return bytes.is_number_unsigned(); };
    if (sensor.at("bytes").size() != outputs.size() || !std::ranges::all_of(sensor.at("bytes"), is_size))
      return false;
    for (const char *key : {"frame_ms", "passes_ms", "check_ms"})
      if (!sensor.contains(key))
        return false;
  }
  return true;
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
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in && (errno == ENOENT || errno == ESTALE))
    return std::nullopt;
  if (!in)
    throw Error(ExitCode::output,
                fmt::format("{}: cannot be read: {}", file.string(), std::generic_category().message(errno)));
  try {
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    ordered_json record = ordered_json::parse(text);
    if (record.at("frame") == frame && record.at("run") == run_hash && has_its_form(record))
      return record;
    return std::nullopt;
  } catch (const nlohmann::json::exception &) { // as a power cut may leave it
    return std::nullopt;
  }
}

bool has_its_files(const fs::path &folder, const ordered_json &record) {
  for (const ordered_json &sensor : record.at("sensors")) {
    const ordered_json &outputs = sensor.at("manifest").at("outputs");
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      std::error_code absent;
      const std::uintmax_t bytes = fs::file_size(folder / outputs[i].get<std::string>(), absent);
      if (absent || bytes != sensor.at("bytes").at(i).get<std::uint64_t>())
        return false;
    }
  }
  return true;
}

std::vector<std::uint32_t> recorded_frames(const fs::path &folder) {
  std::vector<std::uint32_t> frames;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (const auto frame = frame_of(entry->path().filename().native()))
      frames.push_back(*frame);
  if (error)
    throw Error(ExitCode::output, fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
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
