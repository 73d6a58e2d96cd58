#include "host/output/page/run_content.h"

#include "engine/model/error.h"
#include "host/input/file/input_file.h"
#include "host/input/frame/frame_file.h"
#include "host/output/run/frame_records.h"
#include "host/output/run/run_identity.h"
#include "host/output/run/run_json.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <map>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char *expected = "expected what render, deform or correct leaves beside its frames";

// In the directory itself and not hidden.
bool is_plain_name(const std::string &name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

Error no_manifest(const fs::path &file) {
  return input_error(Place{file}, fmt::format("is no manifest, {}", expected));
}

std::uint32_t frame_of(const ordered_json &entry, const fs::path &manifest) {
  const ordered_json &frame = entry.at("frame");
  if (!frame.is_number_unsigned() || frame > std::numeric_limits<std::uint32_t>::max())
    throw no_manifest(manifest);
  return frame.get<std::uint32_t>();
}

// The outputs' names, or json::exception.
std::vector<std::string> names_of(const ordered_json &entry) {
  return entry.at("outputs").get<std::vector<std::string>>();
}

// The first that is read, in the order of the endings.
fs::path file_with_channels(const fs::path &directory, const std::vector<std::string> &names) {
  for (const std::string_view ending : frame_file_endings)
    for (const std::string &name : names)
      if (is_plain_name(name) && name.ends_with(ending))
        return directory / name;
  return {};
}

Error no_channels(const fs::path &manifest, const std::string &sensor, std::uint32_t frame) {
  return input_error(
      Place{manifest},
      fmt::format("{}, frame {}: expected a file of all its channels ({}) among the outputs, as "
                  "--format exr writes it",
                  in_quotes(sensor), frame, fmt::join(frame_file_endings, ", ")));
}

// `place_of` has the places of sensors in the run, by their names.
void add_frame(RunContent &run, std::map<std::string, std::size_t> &place_of, const fs::path &manifest,
               ordered_json &entry) {
  const auto name = entry.at("sensor").get<std::string>();
  const std::uint32_t number = frame_of(entry, manifest);
  fs::path file = file_with_channels(run.directory, names_of(entry));
  if (file.empty())
    throw no_channels(manifest, name, number);
  if (std::error_code ignored; fs::is_symlink(file, ignored)) // to whatever it leads
    throw input_error(Place{manifest}, fmt::format("{}, frame {}: {} is a link, expected a file",
                                                   in_quotes(name), number, file.filename().string()));
  const auto [place, is_new] = place_of.try_emplace(name, run.sensors.size());
  if (is_new)
    run.sensors.push_back({name, {}});
  entry.erase("outputs");
  run.sensors[place->second].frames.push_back({number, std::move(entry), std::move(file)});
}

ordered_json parsed_manifest(const fs::path &file) {
  std::string text;
  try {
    text = read_regular_file(file, max_manifest_bytes, Place{file});
  } catch (const Error &error) {
    throw Error(error.code(), fmt::format("{}, {}", error.what(), expected), error.where());
  }
  auto manifest = parsed_in_order(text, file, max_manifest_values);
  if (!manifest || !manifest->is_object())
    throw no_manifest(file);
  return std::move(*manifest);
}

} // namespace

RunContent read_run(const fs::path &directory, const std::optional<FrameRange> &frames) {
  const fs::path file = directory / manifest_name;
  RunContent run{directory, parsed_manifest(file), {}};
  try {
    auto entries = std::move(run.head.at("frames").get_ref<ordered_json::array_t &>());
    run.head.erase("frames");
    std::map<std::string, std::size_t> place_of;
    for (ordered_json &entry : entries)
      if (!frames || frames->contains(frame_of(entry, file)))
        add_frame(run, place_of, file, entry);
  } catch (const nlohmann::json::exception &) {
    throw no_manifest(file);
  }
  if (run.sensors.empty())
    throw input_error(Place{file},
                      frames ? fmt::format("has no frame from {} to {}", frames->first, frames->end - 1)
                             : "has no frames");
  return run;
}

ordered_json times_of(const RunContent &run, const std::string &sensor, std::uint32_t frame) {
  ordered_json times = ordered_json::object();
  const auto hash = run.head.find("run");
  if (hash == run.head.end() || !hash->is_string())
    return times;
  const auto record = read_record(run.directory, frame, hash->get<std::string>());
  if (!record)
    return times;
  for (const ordered_json &each : record->at("sensors"))
    if (each.at("manifest").at("sensor") == sensor)
      for (const char *key : {"frame_ms", "passes_ms", "check_ms", "told"})
        if (each.contains(key))
          times[key] = each.at(key);
  return times;
}

} // namespace pmdsim
