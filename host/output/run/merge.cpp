#include "host/output/run/merge.h"

#include "engine/model/error.h"
#include "host/input/file/input_error.h"
#include "host/output/files/durable.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"
#include "host/output/run/run_folder.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr auto time_between_tries = std::chrono::milliseconds(10);
constexpr auto time_between_syncs = std::chrono::milliseconds(500); // each takes about 10 ms

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

// A file of a frame that is the source's own, under a temporary name. The disk has what it holds.
struct Linked {
  fs::path temporary, name;

  // Its file system may have no links, or be another.
  static std::optional<Linked> made(const fs::path &from, const fs::path &name) {
    Linked file{temporary_name(name), name};
    if (::linkat(AT_FDCWD, from.c_str(), AT_FDCWD, file.temporary.c_str(), 0) != 0)
      return std::nullopt;
    return file;
  }
  void give_name() const {
    std::error_code error;
    fs::rename(temporary, name, error);
    remove(); // where both are links to one file, renaming leaves it
    if (error)
      throw write_error(name, error.value());
  }
  void remove() const { ::unlink(temporary.c_str()); }
};

void copy(const fs::path &from, OutputFile &to) {
  constexpr std::size_t block_bytes = std::size_t{1} << 20;
  const int descriptor = ::open(from.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  std::string block(block_bytes, '\0');
  ssize_t count = descriptor < 0 ? -1 : 0;
  while (descriptor >= 0 && (count = ::read(descriptor, block.data(), block.size())) > 0)
    to.write({block.data(), static_cast<std::size_t>(count)});
  const int error_number = errno;
  if (descriptor >= 0)
    ::close(descriptor);
  if (count < 0)
    throw Error(ExitCode::input, fmt::format("{}: cannot be read: {}", from.string(),
                                             std::generic_category().message(error_number)));
}

// A frame whose files have no names yet.
struct Brought {
  Brought(std::uint32_t number, const fs::path &directory) : frame(number), copies(directory) {}
  ~Brought() {
    for (const Linked &file : links)
      file.remove();
  }
  Brought(const Brought &) = delete;
  Brought &operator=(const Brought &) = delete;

  std::uint32_t frame;
  std::vector<Linked> links{};
  OutputSet copies; // and its record
};

// Frames that come into a folder, those of some time together, as the disk takes many files as fast as one.
class Bringing {
public:
  Bringing(RunFolder &into, Merged &merged) : into_(into), merged_(merged) {}

  void bring(const Source &source, std::uint32_t frame) {
    if (into_.claim(frame) != RunFolder::Claim::granted)
      return; // a process that is at the same run there makes it, or has
    const auto record = record_of(source, frame);
    if (!record)
      throw Error(ExitCode::input, fmt::format("{}: frame {} has gone", source.path.string(), frame));
    auto brought = std::make_unique<Brought>(frame, into_.path());
    for (const ordered_json &sensor : record->at("sensors"))
      for (const std::string name : sensor.at("manifest").at("outputs"))
        bring_file(source.path / name, name, *brought);
    RunFolder::add_record(brought->copies, *record);
    waiting_.push_back(std::move(brought));
    if (std::chrono::steady_clock::now() - published_ >= time_between_syncs)
      publish();
  }

  void publish() {
    const auto frames = std::exchange(waiting_, {});
    sync_file_system(into_.path());
    for (const auto &brought : frames) {
      remove_file(into_.path() / record_name(brought->frame)); // it must not speak for the files that come
      for (const Linked &file : brought->links)
        file.give_name();
      into_.publish(brought->copies, brought->frame);
    }
    sync_names(into_.path());
    published_ = std::chrono::steady_clock::now();
  }

private:
  void bring_file(const fs::path &from, const std::string &name, Brought &brought) {
    if (auto linked = Linked::made(from, into_.path() / name)) {
      brought.links.push_back(std::move(*linked));
      ++merged_.linked;
    } else {
      brought.copies.add(name, [&](OutputFile &file) { copy(from, file); });
      ++merged_.copied;
    }
  }

  RunFolder &into_;
  Merged &merged_;
  std::vector<std::unique_ptr<Brought>> waiting_;
  std::chrono::steady_clock::time_point published_ = std::chrono::steady_clock::now();
};

} // namespace

Merged merge_runs(const MergeRequest &request, const std::function<void()> &check) {
  const std::vector<Source> sources = opened_sources(request, check);
  const FrameRange frames = frames_of(request, sources.front());
  const std::vector<std::size_t> places = places_of(frames, sources, check);
  refuse_missing(frames, places, request);
  RunFolder into(request.into, sources.front().run, frames, RunFolder::Earlier::made_again, check);
  Merged merged{into.run().hash};
  merged.left = into.left_warning();
  try {
    Bringing bringing(into, merged);
    for (std::size_t i = 0; i < places.size(); ++i) {
      check();
      bringing.bring(sources[places[i]], frames.at(i));
    }
    bringing.publish();
  } catch (const Error &) {
    into.keep_whole_frames();
    throw;
  }
  merged.frames = into.write_manifest();
  return merged;
}

} // namespace pmdsim
