#include "host/output/run/run_folder.h"

#include "engine/model/error.h"
#include "host/input/words/folder_names.h"
#include "host/output/files/frame_warnings.h"
#include "host/output/files/output_file.h"
#include "host/output/run/run_json.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <fmt/format.h>
#include <regex>
#include <thread>
#include <unistd.h>
#include <utility>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;
using Kind = ByteLocks::Kind;

// The bytes of run.json that are locked, by what they mean.
constexpr std::uint64_t living = living_byte; // shared: is at work here; exclusive: alone
constexpr std::uint64_t writing_manifest = 1;
constexpr std::uint64_t first_frame = 16; // and those after it: that frame is being made
constexpr auto waiting_time = std::chrono::milliseconds(10);
constexpr int last_tries = 300; // to write a manifest when a run ends early

// Removes a file that is to have gone by the end of a scope.
struct Removed {
  fs::path path;
  ~Removed() { ::unlink(path.c_str()); }
};

// A link of its name is no run's file and goes, as what it leads to is nobody's to lock.
std::optional<ByteLocks> opened(const fs::path &file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY);
  if (descriptor >= 0)
    return ByteLocks(descriptor);
  if (errno == ELOOP)
    remove_file(file);
  else if (errno != ENOENT)
    throw write_error(file, errno);
  return std::nullopt;
}

// False where there is a file of that name, or where one who was alone in the folder took the temporary file
// for a dead process's. Without hard links the name is taken, whoever has it.
bool give_name(const ByteLocks &file, const fs::path &temporary, const fs::path &name, bool replacing) {
  if (!replacing) {
    if (::link(temporary.c_str(), name.c_str()) == 0)
      return true;
    if (errno == EEXIST)
      return file.is_at(name); // NFS may say so of what it has just done
    if (errno == ENOENT)
      return false;
  }
  if (::rename(temporary.c_str(), name.c_str()) != 0)
    throw write_error(name, errno);
  return true;
}

// Whether a run leaves files of that name, its own or a frame's.
bool is_of_a_run(const std::string &name) {
  static const std::regex names(
      R"(run\.json|manifest\.json|report\.html|table(\..+)?\.csv|\d{4,}\.record\.json|.+_\d{4,}\..+|.+\.(sheet\.png|apng))");
  return std::regex_match(name, names);
}

// Whether `run` may take the folder of another that is to be kept, as nothing of it would go: frames, or a
// study's table.
bool leaves_all(const fs::path &folder, const std::optional<RunFile> &found, const RunIdentity &run) {
  std::error_code ignored;
  return found && (run.head.contains("study") || !found->run.head.contains("study")) &&
         !fs::exists(folder / manifest_name, ignored) && recorded_frames(folder).empty();
}

} // namespace

RunFolder::RunFolder(const fs::path &directory, RunIdentity run, const FrameRange &frames, Earlier earlier,
                     std::function<void()> wait, bool strict)
    : directory_(directory), run_(std::move(run)), wait_(std::move(wait)), strict_(strict) {
  while (!enter(frames, earlier)) {
    std::this_thread::sleep_for(waiting_time);
    wait_();
  }
}

RunFolder RunFolder::of_existing(const fs::path &directory, const std::function<void()> &wait) {
  return {directory, read_run_file(directory).run, {}, Earlier::kept, wait};
}

RunFolder::~RunFolder() {
  try {
    leave();
  } catch (const std::exception &) {
    return; // leftovers are the next one's to clear
  }
}

// False where it is to be tried again, as another process begins or ends.
bool RunFolder::enter(const FrameRange &frames, Earlier earlier) {
  std::optional<ByteLocks> there = opened(path() / run_file_name);
  if (!there) {
    std::optional<ByteLocks> mine = new_run_file(false);
    if (!mine)
      return false;
    clear(false, frames, earlier);
    settle(std::move(*mine));
    return true;
  }
  const bool alone = there->try_lock(living, Kind::exclusive);
  if (!alone && !there->try_lock(living, Kind::shared))
    return false;
  if (!there->is_at(path() / run_file_name))
    return false;
  return alone ? enter_alone(std::move(*there), frames, earlier) : enter_beside_others(std::move(*there));
}

// The run's file is a new one each time, as it tells who has begun; the old one stays locked until then.
bool RunFolder::enter_alone(ByteLocks there, const FrameRange &frames, Earlier earlier) {
  const std::optional<RunFile> found =
      parsed_run_file(there.content(max_run_json_bytes), path() / run_file_name);
  const bool same_run = found && found->run == run_;
  if (!same_run && earlier == Earlier::kept && !leaves_all(path(), found, run_))
    throw Error(ExitCode::input, fmt::format("{}: --resume: it holds another run: {}", path().string(),
                                             found ? difference_text(found->run, run_)
                                                   : fmt::format("its {} cannot be read", run_file_name)));
  std::optional<ByteLocks> mine = new_run_file(true);
  clear(same_run, frames, earlier);
  if (left_.frames > 0 && found)
    left_.difference = difference_text(found->run, run_);
  settle(std::move(*mine));
  return true;
}

bool RunFolder::enter_beside_others(ByteLocks there) {
  const std::optional<RunFile> found =
      parsed_run_file(there.content(max_run_json_bytes), path() / run_file_name);
  if (found && found->run == run_) {
    joined_ = true;
    locks_ = std::move(there);
    return true;
  }
  if (there.try_lock(living, Kind::exclusive)) // they have ended meanwhile
    return false;
  throw Error(ExitCode::output,
              fmt::format("{}: another run is being written there{}", path().string(),
                          found ? fmt::format(", begun by process {} on {}: {}", found->beginner.process,
                                              found->beginner.host, difference_text(found->run, run_))
                                : std::string()));
}

// Nobody else can be in the folder before its lock is shared. Nothing where another was faster.
std::optional<ByteLocks> RunFolder::new_run_file(bool replacing) const {
  const fs::path name = path() / run_file_name, temporary = temporary_name(name);
  const int descriptor = ::open(temporary.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0)
    throw write_error(name, errno);
  ByteLocks file(descriptor);
  const Removed removed{temporary};
  file.write(run_file_text(run_, this_process()), name);
  file.try_lock(living, Kind::exclusive);
  if (!give_name(file, temporary, name, replacing))
    return std::nullopt;
  return file;
}

void RunFolder::settle(ByteLocks mine) {
  if (mine.works())
    remove_leftovers();
  mine.try_lock(living, Kind::shared);
  locks_ = std::move(mine);
}

void RunFolder::clear(bool same_run, const FrameRange &frames, Earlier earlier) {
  bool any = !same_run;
  for (const std::uint32_t frame : recorded_frames(path()))
    if (!same_run || (earlier == Earlier::made_again && frames.contains(frame))) {
      remove_file(path() / record_name(frame));
      any = true;
      left_.frames += frame >= frames.end || frame + frames.step <= frames.first ? 1 : 0;
    }
  if (any)
    remove_file(path() / manifest_name);
}

void RunFolder::remove_leftovers() const {
  std::error_code ignored;
  for (const std::string &file : names_in(path(), ignored)) {
    const auto name = name_of_temporary(file);
    if (name && is_of_a_run(*name))
      remove_file(path() / file);
  }
}

std::optional<Warning> RunFolder::left_warning() const {
  if (left_.frames == 0)
    return std::nullopt;
  const std::string why = left_.difference.empty() ? "" : fmt::format(" ({})", left_.difference);
  return Warning{
      warning_code("earlier-frames-left"), path().string(),
      fmt::format("{} frame{} of another run{} {} there as files that the manifest does not list; another "
                  "-o keeps runs apart",
                  left_.frames, left_.frames == 1 ? "" : "s", why, left_.frames == 1 ? "stays" : "stay")};
}

std::optional<nlohmann::ordered_json> RunFolder::whole(std::uint32_t frame) const {
  auto record = read_record(path(), frame, run_.hash);
  if (record && (!has_its_files(path(), *record) || (strict_ && has_warnings(*record))))
    record.reset();
  return record;
}

RunFolder::Claim RunFolder::claim(std::uint32_t frame) {
  if (!locks_->try_lock(first_frame + frame, Kind::exclusive))
    return Claim::taken;
  if (!whole(frame))
    return Claim::granted;
  give_back(frame);
  return Claim::whole;
}

void RunFolder::give_back(std::uint32_t frame) { locks_->unlock(first_frame + frame); }

bool RunFolder::seems_free(std::uint32_t frame) const {
  return !locks_->is_held_by_another(first_frame + frame) &&
         ::access((path() / record_name(frame)).c_str(), F_OK) != 0;
}

void RunFolder::add_record(OutputSet &files, const nlohmann::ordered_json &record) {
  files.add(record_name(record.at("frame").get<std::uint32_t>()),
            [&](OutputFile &file) { file.write(json_text(record)); });
}

void RunFolder::publish(OutputSet &files, std::uint32_t frame) {
  files.give_names(
      {record_name(frame)}); // a record of files that have gone must not speak for those that come
  directory_.stay();
  give_back(frame);
}

void RunFolder::lock_manifest(const std::function<void()> &wait) {
  while (!locks_->try_lock(writing_manifest, Kind::exclusive)) {
    std::this_thread::sleep_for(waiting_time);
    wait();
  }
}

std::size_t RunFolder::write_manifest() { return write_manifest(wait_); }

std::size_t RunFolder::write_manifest(const std::function<void()> &wait) {
  std::size_t frames = 0;
  lock_manifest(wait);
  OutputSet files(path());
  files.add(manifest_name, [&](OutputFile &file) {
    nlohmann::ordered_json head = run_.head;
    const nlohmann::ordered_json of_setup = head.value("warnings", nlohmann::ordered_json::array());
    head.erase("warnings");
    FrameWarnings of_frames;
    head["run"] = run_.hash;
    JsonPieces pieces([&](std::string_view text) { file.write(text); }, head);
    pieces.list("frames", [&](const JsonPieces::Add &add) {
      for (const std::uint32_t frame : recorded_frames(path()))
        if (const auto record = read_record(path(), frame, run_.hash);
            record && has_its_files(path(), *record)) {
          ++frames;
          for (const auto &sensor : record->at("sensors")) {
            const nlohmann::ordered_json &entry = sensor.at("manifest");
            add(entry);
            for (const auto &warning : entry.value("warnings", nlohmann::ordered_json::array()))
              of_frames.add(warning_of(warning), frame);
          }
        }
    });
    pieces.list("warnings", [&](const JsonPieces::Add &add) {
      std::ranges::for_each(of_setup, add);
      for (const Warning &warning : of_frames.merged())
        add(warning_json(warning));
    });
    pieces.end();
  });
  files.publish();
  directory_.stay();
  has_manifest_ = true;
  locks_->unlock(writing_manifest);
  return frames;
}

bool RunFolder::keep_whole_frames() noexcept {
  try {
    int tries = last_tries;
    const auto wait = [&] { // an interruption, which may have brought us here, must not end it at once
      if (--tries == 0)
        throw Error(ExitCode::output, "another process writes the manifest");
    };
    if (!recorded_frames(path()).empty())
      write_manifest(wait);
    return true;
  } catch (const std::exception &) { // the error that brought us here is the one to tell
    return false;
  }
}

void RunFolder::leave() {
  if (!locks_ || !locks_->try_lock(living, Kind::exclusive) || !locks_->works())
    return;
  remove_leftovers();
  if (!has_manifest_ && recorded_frames(path()).empty()) {
    remove_file(path() / manifest_name);
    remove_file(path() / run_file_name);
  }
}

} // namespace pmdsim
