#include "host/output/sheets/sheets.h"

#include "host/input/words/folder_names.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"
#include "host/output/pictures/preview.h"
#include "host/output/run/frame_records.h"
#include "host/output/run/run_identity.h"
#include "host/output/sheets/animation.h"
#include "host/output/sheets/contact_sheet.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::uint32_t most_shown = 36;
constexpr std::uint32_t most_frames = 100'000; // as of any setup
// Far more than a run's sensors have, as records may have been edited.
constexpr std::size_t most_strips = 4096;
constexpr std::uint16_t frame_ms = 250;
constexpr std::array<std::string_view, 2> endings{".sheet.png", ".apng"};

// The frames that the pictures of so many show.
std::vector<std::uint32_t> shown_of(std::uint32_t frame_count) {
  const std::uint32_t count = std::min(frame_count, most_shown);
  std::vector<std::uint32_t> shown;
  for (std::uint32_t i = 0; i < count; ++i)
    shown.push_back(
        count == 1 ? 0 : static_cast<std::uint32_t>(std::uint64_t{i} * (frame_count - 1) / (count - 1)));
  return shown;
}

// 0 where the run does not tell.
std::uint32_t frame_count_of(const RunIdentity &run) {
  static const ordered_json::json_pointer place("/setup/frames/count");
  const ordered_json count = run.head.contains(place) ? run.head.at(place) : ordered_json();
  return count.is_number_unsigned() && count <= most_frames ? count.get<std::uint32_t>() : 0;
}

// By sensor and channel.
using Strips = std::map<std::pair<std::string, std::string>, FilmStrip>;

// False where the frame keeps nothing, or something that is none.
bool add_frame(const ordered_json &record, std::uint32_t frame, Strips &strips) {
  for (const ordered_json &sensor : record.at("sensors")) {
    const auto kept = sensor.find("thumbnails");
    if (kept == sensor.end() || !kept->is_array())
      return false;
    const std::string &name = sensor.at("manifest").at("sensor").get_ref<const std::string &>();
    for (const ordered_json &json : *kept) {
      std::optional<Thumbnail> thumbnail = parsed_thumbnail(json);
      if (!thumbnail)
        return false;
      FilmStrip &strip = strips[{name, thumbnail->channel}];
      strip.sensor = name;
      strip.frames.push_back(frame);
      strip.thumbnails.push_back(std::move(*thumbnail));
      if (strips.size() > most_strips)
        return false;
    }
  }
  return true;
}

bool is_whole(const FilmStrip &strip, const std::vector<std::uint32_t> &shown) {
  const auto size_of = [](const Thumbnail &thumbnail) { return thumbnail.image.resolution; };
  const glm::uvec2 size = size_of(strip.thumbnails.front());
  return strip.frames == shown &&
         std::ranges::all_of(
             strip.thumbnails, [&](const glm::uvec2 &other) { return other == size; }, size_of);
}

// Empty where something is missing.
Strips strips_of(const fs::path &folder, const std::string &run_hash, const std::vector<std::uint32_t> &shown,
                 const std::function<void()> &check) {
  Strips strips;
  for (const std::uint32_t frame : shown) {
    check();
    const auto record = read_record(folder, frame, run_hash);
    if (!record || !has_its_files(folder, *record) || !add_frame(*record, frame, strips))
      return {};
  }
  std::erase_if(strips, [&](const auto &of) {
    return !is_plain_name(of.second.sensor) || !is_plain_name(of.first.second) || !is_whole(of.second, shown);
  });
  return strips;
}

void write_animation(OutputFile &file, const FilmStrip &strip, std::uint32_t frame_count,
                     const std::function<void()> &check) {
  const Colouring colouring = colouring_of(strip);
  const std::size_t digits = std::to_string(frame_count - 1).size();
  AnimatedPng animation(file, static_cast<std::uint32_t>(strip.frames.size()), frame_ms);
  for (std::size_t i = 0; i < strip.frames.size(); ++i) {
    check();
    const Thumbnail &thumbnail = strip.thumbnails[i];
    PreviewImage image = thumbnail.image;
    image.enlargement = enlargement_of(image.resolution);
    // Figures are equally wide, so that all titles, and with them the pictures, are.
    const std::string title =
        fmt::format("{}, {}, frame {:0{}}", thumbnail.quantity, strip.sensor, strip.frames[i], digits);
    animation.add(draw_preview(image, colouring, thumbnail.frame_resolution, thumbnail.quantity,
                               thumbnail.unit, title));
  }
  animation.end();
}

} // namespace

bool is_in_sheets(std::uint32_t frame, std::uint32_t frame_count) {
  return frame_count > 1 && std::ranges::binary_search(shown_of(frame_count), frame);
}

ordered_json thumbnails_json(const ChannelSet &channels) {
  return array_of(thumbnails_of(channels), thumbnail_json);
}

std::vector<std::string> write_sheets(const fs::path &folder, const std::function<void()> &check) {
  const RunIdentity run = read_run_file(folder).run;
  const std::uint32_t frame_count = frame_count_of(run);
  if (frame_count < 2)
    return {};
  const Strips strips = strips_of(folder, run.hash, shown_of(frame_count), check);
  if (strips.empty())
    return {};
  OutputSet files(folder);
  std::vector<std::string> names;
  const auto add = [&](const std::string &name, const auto &write) {
    files.add(name, write);
    names.push_back(name);
  };
  for (const auto &[of, strip] : strips) {
    check();
    const std::scoped_lock alone(drawing_mutex());
    const std::string stem = fmt::format("{}.{}", of.first, of.second);
    add(stem + std::string(endings[0]),
        [&](OutputFile &file) { draw_contact_sheet(strip, frame_count).write_png(file); });
    add(stem + std::string(endings[1]),
        [&](OutputFile &file) { write_animation(file, strip, frame_count, check); });
  }
  files.publish();
  return names;
}

void remove_sheets(const fs::path &folder, const std::string &sensor) {
  std::error_code ignored;
  for (const std::string &name : names_in(folder, ignored))
    if (name.starts_with(sensor + ".") &&
        std::ranges::any_of(endings, [&](std::string_view ending) { return name.ends_with(ending); }))
      remove_file(folder / name);
}

} // namespace pmdsim
