#include "host/capture/frame_sequence.h"

#include "engine/model/error.h"
#include "host/capture/pipeline.h"
#include "host/capture/progress.h"
#include "host/input/file/content_hash.h"
#include "host/output/files/durable.h"
#include "host/output/sheets/sheets.h"
#include "host/report/report.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <iterator>
#include <tbb/info.h>
#include <thread>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t waiting_bytes = std::size_t{1} << 30;
constexpr auto time_between_looks = std::chrono::milliseconds(50);  // at frames of other processes
constexpr auto time_between_syncs = std::chrono::milliseconds(500); // each takes about 10 ms

// As it will be read from its file, where text that is not UTF-8 is replaced.
RunIdentity identity_of(const RunHead &run) {
  const std::string text = json_text(head_json(run));
  return {ordered_json::parse(text), content_hash(text)};
}

std::string frames_text(std::uint32_t first, std::uint32_t last) {
  return first == last ? fmt::format("frame {}", first) : fmt::format("frames {} to {}", first, last);
}

} // namespace

std::size_t parts_waiting(std::size_t part_bytes, std::uint64_t room) {
  const auto busy = static_cast<std::size_t>(tbb::info::default_concurrency());
  const std::size_t most_bytes = std::min<std::uint64_t>(waiting_bytes, room);
  return std::min(busy, most_bytes / std::max(part_bytes, std::size_t{1}));
}

FrameSequence::FrameSequence(const Setup &setup, SequenceRequest request, const RunHead &run)
    : setup_(setup), request_(std::move(request)), run_(run) {}

std::uint32_t FrameSequence::begin() {
  folder_.emplace(request_.directory, identity_of(run_), request_.frames, request_.earlier,
                  throw_if_interrupted, request_.strict);
  request_.directory = folder_->path();
  if (!folder_->has_locks())
    warn({warning_code("no-locks"), request_.directory.string(),
          "its file system has no locks, no other process may write there"});
  if (const auto left = folder_->left_warning())
    warn(*left);
  const std::vector<std::uint32_t> recorded = recorded_frames(request_.directory);
  for (std::uint32_t i = 0; i < request_.frames.count(); ++i)
    if (const std::uint32_t frame = request_.frames.at(i);
        !std::ranges::binary_search(recorded, frame) || !folder_->whole(frame))
      to_do_.push_back(frame);
  to_do_at_start_ = static_cast<std::uint32_t>(to_do_.size());
  if (to_do_at_start_ > 0 && !folder_->is_joined())
    for (const Sensor &sensor : setup_.start.sensors)
      remove_sheets(request_.directory, sensor.name);
  return to_do_at_start_;
}

void FrameSequence::write(const Measure &measure, std::size_t part_bytes, std::uint64_t room) {
  try {
    make_all(measure, parts_waiting(part_bytes, room));
    throw_if_interrupted();
    sheets_ = write_sheets(request_.directory, throw_if_interrupted);
    folder_->write_manifest();
  } catch (const Error &error) {
    files_.clear(); // first, as the disk may be full
    keep_finished();
    const bool has_manifest = folder_->keep_whole_frames();
    if (std::error_code ignored; made_.count == 0 || !std::filesystem::exists(request_.directory, ignored))
      throw;
    throw Error(error.code(),
                fmt::format("{}; {} in {}{}", error.what(), whole_text(), request_.directory.string(),
                            has_manifest ? "" : ", without a manifest"));
  } catch (...) {
    files_.clear();
    keep_finished();
    folder_->keep_whole_frames();
    throw;
  }
}

void FrameSequence::make_all(const Measure &measure, std::size_t waiting) {
  while (!to_do_.empty()) {
    const bool any = make_free_ones(measure, waiting);
    std::erase_if(taken_, [&](std::uint32_t frame) { return folder_->whole(frame).has_value(); });
    to_do_ = std::exchange(taken_, {});
    throw_if_interrupted();
    if (!any && !to_do_.empty())
      std::this_thread::sleep_for(time_between_looks);
  }
}

// Whether there were any. A part, not a frame, goes through the pipeline: frames of several large sensors
// would not fit side by side.
bool FrameSequence::make_free_ones(const Measure &measure, std::size_t waiting) {
  struct Part {
    SensorFrame at;
    MeasuredPart measured;
  };
  std::optional<std::uint32_t> frame;
  bool any = false;
  run_pipeline(
      [&](std::size_t i) {
        if (i % sensor_count() == 0)
          frame = claim_next();
        any = any || frame;
        return frame.has_value();
      },
      waiting,
      [&](std::size_t i) {
        const SensorFrame at = part(*frame, i % sensor_count());
        return Part{at, measure(at)};
      },
      [&](std::size_t, Part part) {
        FrameRecord record = std::move(part.measured.record);
        const std::vector<FileToWrite> files = part.measured.files(record);
        return WrittenPart{std::move(part.at), std::move(record), write_files(request_.directory, files)};
      },
      [&](std::size_t, WrittenPart written) { add(std::move(written)); });
  publish_finished();
  return any;
}

std::optional<std::uint32_t> FrameSequence::claim_next() {
  while (!to_do_.empty()) {
    throw_if_interrupted();
    const std::uint32_t frame = to_do_.front();
    to_do_.pop_front();
    switch (folder_->claim(frame)) {
    case RunFolder::Claim::granted:
      return frame;
    case RunFolder::Claim::taken:
      taken_.push_back(frame);
      break;
    case RunFolder::Claim::whole:
      break;
    }
  }
  return std::nullopt;
}

void FrameSequence::add(WrittenPart part) {
  for (const auto &file : part.files)
    part.record.outputs.push_back({file->path().filename().string(), file->size_bytes()});
  std::ranges::move(part.files, std::back_inserter(files_));
  parts_.push_back(std::move(part.record));
  if (part.at.sensor + 1 == sensor_count())
    finish_frame();
}

void FrameSequence::finish_frame() {
  throw_if_interrupted();
  auto frame = std::make_unique<Finished>(request_.directory);
  frame->files.add(std::exchange(files_, {}));
  frame->parts = std::exchange(parts_, {});
  RunFolder::add_record(frame->files, record_json(folder_->run().hash, frame->parts));
  finished_.push_back(std::move(frame));
  if (std::chrono::steady_clock::now() - synced_ >= time_between_syncs)
    publish_finished();
}

void FrameSequence::publish_finished() {
  auto finished = std::exchange(finished_, {}); // gone where the disk does not take them
  if (finished.empty())
    return;
  sync_file_system(request_.directory);
  for (const auto &frame : finished)
    publish(*frame);
  sync_names(request_.directory);
  synced_ = std::chrono::steady_clock::now();
}

// Where the run ends early; why is told already.
void FrameSequence::keep_finished() noexcept {
  try {
    publish_finished();
  } catch (const std::exception &) {
    return;
  }
}

void FrameSequence::publish(Finished &finished) {
  const std::uint32_t frame = finished.parts.front().frame;
  folder_->publish(finished.files, frame);
  if (made_.count == 0) {
    made_.first = frame;
    for (const FrameRecord &part : finished.parts)
      for (const NamedFile &file : part.outputs)
        made_.names_of_first.push_back(file.name);
  } else if (frame != made_.last + 1) {
    made_.in_a_row = false;
  }
  made_.last = frame;
  ++made_.count;
}

SensorFrame FrameSequence::part(std::uint32_t frame, std::size_t sensor) const {
  const FrameRange &frames = request_.frames;
  const std::string label = frames.count() > 1
                                ? fmt::format("frame {}/{}, ", frames.index_of(frame) + 1, frames.count())
                                : "measuring ";
  SensorFrame part{frame, setup_.frames.time_s(frame), sensor, label + setup_.start.sensors[sensor].name};
  if (sensor + 1 < sensor_count())
    part.next_s = part.time_s;
  else if (const auto next = next_after(frame))
    part.next_s = setup_.frames.time_s(*next);
  part.is_in_sheets = is_in_sheets(frame, setup_.frames.count);
  part.frames_done = to_do_at_start_ - static_cast<std::uint32_t>(to_do_.size() + taken_.size()) - 1;
  return part;
}

// The next that is likely to be ours.
std::optional<std::uint32_t> FrameSequence::next_after(std::uint32_t frame) const {
  const auto is_free = [&](std::uint32_t other) { return other > frame && folder_->seems_free(other); };
  const auto next = std::ranges::find_if(to_do_, is_free);
  return next == to_do_.end() ? std::nullopt : std::optional(*next);
}

void FrameSequence::for_each_record(const std::function<void(const ordered_json &)> &use) const {
  for (std::uint32_t i = 0; i < request_.frames.count(); ++i) {
    const std::uint32_t frame = request_.frames.at(i);
    const auto record = read_record(request_.directory, frame, folder_->run().hash);
    if (!record)
      throw Error(ExitCode::output,
                  fmt::format("{}: cannot be read: it has gone", path_of(record_name(frame))));
    try {
      use(*record);
    } catch (const nlohmann::json::exception &) {
      throw Error(ExitCode::input,
                  fmt::format("{}: expected what this run leaves of a frame", path_of(record_name(frame))));
    }
  }
}

std::string FrameSequence::whole_text() const {
  if (!made_.in_a_row)
    return fmt::format("{} frames are whole and stay", made_.count);
  return fmt::format("{} {}", frames_text(made_.first, made_.last),
                     made_.count == 1 ? "is whole and stays" : "are whole and stay");
}

std::string FrameSequence::written_text() const {
  std::string text = "written:\n";
  for (const std::string &name : made_.names_of_first)
    text += fmt::format("  {}\n", path_of(name));
  if (made_.count > 1)
    text += made_.in_a_row ? fmt::format("  and the same of {}\n", frames_text(made_.first + 1, made_.last))
                           : fmt::format("  and the same of {} frames more\n", made_.count - 1);
  for (const std::string &name : sheets_)
    text += fmt::format("  {}\n", path_of(name));
  text += fmt::format("  {}\n", path_of(manifest_name));
  if (const std::uint32_t kept = request_.frames.count() - to_do_at_start_; kept > 0)
    text += fmt::format("{} frame{} there before\n", kept, kept == 1 ? " was" : "s were");
  if (const std::uint32_t others = to_do_at_start_ - made_.count; others > 0)
    text += fmt::format("{} frame{} made by other processes\n", others, others == 1 ? " was" : "s were");
  return text;
}

} // namespace pmdsim
