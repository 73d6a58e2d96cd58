#include "host/output/run/merge.h"

#include "engine/model/error.h"
#include "host/input/file/input_error.h"
#include "host/output/files/manifest.h"
#include "host/output/run/run_folder.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr auto time_between_tries = std::chrono::milliseconds(10);

// A folder that nobody begins another run in while it is read.
struct Source {
  fs::path path;
  RunIdentity run;
  std::optional<ByteLocks> lock; // none where it cannot be had, as on a medium that is read-only
};

Source opened(const fs::path &folder, const std::function<void()> &check) {
  const fs::path file = folder / run_file_name;
  while (true) {
    check();
    Source source{folder, read_run_file(folder).run, std::nullopt};
    if (const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC); descriptor >= 0)
      source.lock.emplace(descriptor);
    if (!source.lock ||
        (source.lock->try_lock(living_byte, ByteLocks::Kind::shared) && source.lock->is_at(file)))
      return source;
    std::this_thread::sleep_for(time_between_tries);
  }
}

std::vector<Source> opened_sources(const MergeRequest &request, const std::function<void()> &check) {
  std::vector<Source> sources;
  for (const fs::path &path : request.sources) {
    std::error_code absent;
    if (fs::equivalent(path, request.into, absent) && !absent)
      throw Error(ExitCode::usage,
                  fmt::format("-o {}: expected none of the directories that are merged", path.string()));
    sources.push_back(opened(path, check));
    if (sources.back().run != sources.front().run)
      throw Error(ExitCode::input,
                  fmt::format("{}: expected the run of {}: {}", path.string(), sources.front().path.string(),
                              difference_text(sources.back().run, sources.front().run)));
  }
  return sources;
}

// How many frames the setup has.
std::uint32_t frame_count_of(const Source &source) {
  static const ordered_json::json_pointer place("/setup/frames/count");
  constexpr std::uint32_t most = 100'000; // as of any setup
  const ordered_json &head = source.run.head;
  const ordered_json count = head.contains(place) ? head.at(place) : ordered_json();
  if (!count.is_number_unsigned() || count < 1 || count > most)
    throw input_error(Place{source.path / run_file_name} / "setup" / "frames" / "count",
                      fmt::format("expected the number of the run's frames, 1 to {}", most));
  return count;
}

FrameRange frames_of(const MergeRequest &request, const Source &source) {
  const std::uint32_t count = frame_count_of(source);
  const FrameRange frames = request.frames.value_or(FrameRange{0, count});
  if (frames.end > count)
    throw Error(ExitCode::usage, fmt::format("--frames {}:{}: expected B at most {}, the frames of {}",
                                             frames.first, frames.end, count, source.path.string()));
  return frames;
}

// The record of a frame that is whole.
std::optional<ordered_json> record_of(const Source &source, std::uint32_t frame) {
  auto record = read_record(source.path, frame, source.run.hash);
  return record && has_its_files(source.path, *record) ? record : std::nullopt;
}

// What is the same in every record of a frame.
std::vector<ordered_json> lasting_part(const ordered_json &record) {
  std::vector<ordered_json> parts;
  for (const ordered_json &sensor : record.at("sensors")) {
    parts.push_back(sensor.at("manifest"));
    parts.push_back(sensor.at("bytes"));
  }
  return parts;
}

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

// Which source each frame of the range is to come from, or nowhere.
std::vector<std::size_t> places_of(const FrameRange &frames, const std::vector<Source> &sources,
                                   const std::function<void()> &check) {
  std::vector<std::size_t> places(frames.count(), nowhere);
  for (std::size_t i = 0; i < sources.size(); ++i)
    for (const std::uint32_t frame : recorded_frames(sources[i].path)) {
      check();
      const auto record = frames.contains(frame) ? record_of(sources[i], frame) : std::nullopt;
      if (!record)
        continue;
      std::size_t &place = places[frames.index_of(frame)];
      if (place == nowhere)
        place = i;
      else if (const auto other = record_of(sources[place], frame);
               other && lasting_part(*other) != lasting_part(*record))
        throw Error(ExitCode::input,
                    fmt::format("{}: frame {}: expected what {} has, its files or what they hold differ",
                                sources[i].path.string(), frame, sources[place].path.string()));
    }
  return places;
}

// "3, 7 to 9".
std::string missing_text(const FrameRange &frames, const std::vector<std::size_t> &places) {
  constexpr std::size_t most = 100;
  std::vector<std::string> gaps;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t first = i;
    while (i < places.size() && places[i] == nowhere)
      ++i;
    if (i - first == 1)
      gaps.push_back(fmt::format("{}", frames.at(first)));
    else if (i > first)
      gaps.push_back(fmt::format("{} to {}", frames.at(first), frames.at(i - 1)));
  }
  if (gaps.size() > most) {
    gaps.resize(most);
    gaps.emplace_back("...");
  }
  return fmt::format("{}", fmt::join(gaps, ", "));
}

void refuse_missing(const FrameRange &frames, const std::vector<std::size_t> &places,
                    const MergeRequest &request) {
  const auto missing = std::ranges::count(places, nowhere);
  if (missing == 0)
    return;
  std::vector<std::string> names;
  for (const fs::path &path : request.sources)
    names.push_back(path.string());
  throw Error(ExitCode::input,
              fmt::format("{}: expected every frame to be whole, missing {}: {}", fmt::join(names, ", "),
                          missing == 1 ? "is" : "are", missing_text(frames, places)));
}

// Links or copies it, under its name at once. Whether it is a link.
bool bring(const fs::path &from, const fs::path &to) {
  const fs::path temporary = temporary_name(to);
  const bool linked = ::linkat(AT_FDCWD, from.c_str(), AT_FDCWD, temporary.c_str(), AT_SYMLINK_FOLLOW) == 0;
  std::error_code error;
  if (!linked)
    fs::copy_file(from, temporary, error);
  if (!error)
    fs::rename(temporary, to, error);
  ::unlink(temporary.c_str()); // where both are links to one file, renaming leaves it
  if (error)
    throw write_error(to, error.value());
  return linked;
}

void bring_frame(const Source &source, std::uint32_t frame, RunFolder &into, Merged &merged) {
  if (into.claim(frame) != RunFolder::Claim::granted)
    return; // a process that is at the same run there makes it, or has
  const auto record = record_of(source, frame);
  if (!record)
    throw Error(ExitCode::input, fmt::format("{}: frame {} has gone", source.path.string(), frame));
  remove_file(into.path() / record_name(frame)); // it must not speak for the files that come
  for (const ordered_json &sensor : record->at("sensors"))
    for (const std::string name : sensor.at("manifest").at("outputs"))
      ++(bring(source.path / name, into.path() / name) ? merged.linked : merged.copied);
  OutputSet of_record(into.path());
  RunFolder::add_record(of_record, *record);
  into.publish(of_record, frame);
}

} // namespace

Merged merge_runs(const MergeRequest &request, const std::function<void()> &check) {
  const std::vector<Source> sources = opened_sources(request, check);
  const FrameRange frames = frames_of(request, sources.front());
  const std::vector<std::size_t> places = places_of(frames, sources, check);
  refuse_missing(frames, places, request);
  RunFolder into(request.into, sources.front().run, frames, RunFolder::Earlier::made_again, check);
  Merged merged{into.run().hash};
  try {
    for (std::size_t i = 0; i < places.size(); ++i) {
      check();
      bring_frame(sources[places[i]], frames.at(i), into, merged);
    }
  } catch (const Error &) {
    into.keep_whole_frames();
    throw;
  }
  merged.frames = into.write_manifest();
  return merged;
}

} // namespace pmdsim
