#include "host/capture/frame_sequence.h"

#include "engine/model/error.h"
#include "host/capture/pipeline.h"
#include "host/capture/progress.h"
#include "host/report/report.h"

#include <algorithm>
#include <fmt/format.h>
#include <tbb/info.h>

namespace pmdsim {
namespace {

constexpr std::size_t waiting_bytes = std::size_t{1} << 30;

void add_manifest(OutputSet &files, const RunRecord &run) {
  files.add(manifest_name, [&](OutputFile &file) { write_manifest(file, run); });
}

std::string whole_text(const std::vector<FrameRecord> &frames) {
  const std::uint32_t first = frames.front().frame, last = frames.back().frame;
  return first == last ? fmt::format("frame {} is whole and stays", first)
                       : fmt::format("frames {} to {} are whole and stay", first, last);
}

} // namespace

std::size_t parts_waiting(std::size_t part_bytes) {
  const auto busy = static_cast<std::size_t>(tbb::info::default_concurrency());
  return std::min(busy, waiting_bytes / std::max(part_bytes, std::size_t{1}));
}

FrameSequence::FrameSequence(const Setup &setup, const FrameRange &frames,
                             const std::filesystem::path &directory, RunRecord run)
    : setup_(setup), frames_(frames), files_(std::make_unique<OutputSet>(directory)),
      directory_(files_->directory()), run_(std::move(run)) {}

void FrameSequence::write(const Measure &measure, std::size_t part_bytes) {
  try {
    write_all(measure, part_bytes);
  } catch (const Error &error) {
    const bool has_manifest = keep_whole_frames();
    if (run_.frames.empty())
      throw;
    throw Error(error.code(), fmt::format("{}; {} in {}{}", error.what(), whole_text(run_.frames),
                                          directory_.string(), has_manifest ? "" : ", without a manifest"));
  } catch (...) {
    keep_whole_frames();
    throw;
  }
}

// A part, not a frame, goes through the pipeline: frames of several large sensors would not fit side by side.
void FrameSequence::write_all(const Measure &measure, std::size_t part_bytes) {
  run_pipeline(
      frames_.count() * setup_.start.sensors.size(), parts_waiting(part_bytes),
      [&](std::size_t i) { return measure(part(i)); },
      [&](std::size_t, const MeasuredPart &measured) {
        return WrittenPart{measured.record, write_files(directory_, measured.files())};
      },
      [&](std::size_t i, WrittenPart written) { add(part(i), std::move(written)); });
}

void FrameSequence::add(const SensorFrame &at, WrittenPart part) {
  if (!files_)
    files_ = std::make_unique<OutputSet>(directory_);
  for (const auto &file : part.files)
    part.record.outputs.push_back(file->path().filename().string());
  files_->add(std::move(part.files));
  run_.frames.push_back(std::move(part.record));
  if (at.sensor + 1 == setup_.start.sensors.size())
    publish(at.frame);
}

void FrameSequence::publish(std::uint32_t frame) {
  if (frame + 1 == frames_.end)
    add_manifest(*files_, run_);
  throw_if_interrupted();
  // An earlier run's manifest must not speak for this one's frames, however this one ends.
  files_->publish(frame == frames_.first ? std::vector<std::string>{manifest_name}
                                         : std::vector<std::string>{});
  files_.reset();
  whole_ = run_.frames.size();
}

// Whether there is a manifest of them.
bool FrameSequence::keep_whole_frames() noexcept {
  files_.reset(); // first, as the disk may be full
  run_.frames.erase(run_.frames.begin() + static_cast<std::ptrdiff_t>(whole_), run_.frames.end());
  if (run_.frames.empty())
    return false;
  try {
    OutputSet files(directory_);
    add_manifest(files, run_);
    files.publish();
    return true;
  } catch (const std::exception &) { // the error that brought us here is the one to tell
    return false;
  }
}

SensorFrame FrameSequence::part(std::size_t index) const {
  const std::size_t sensors = setup_.start.sensors.size(), sensor = index % sensors;
  const auto frame = frames_.first + static_cast<std::uint32_t>(index / sensors);
  const std::string label = frames_.count() > 1
                                ? fmt::format("frame {}/{}, ", frame - frames_.first + 1, frames_.count())
                                : "measuring ";
  SensorFrame part{frame, setup_.frames.time_s(frame), sensor, label + setup_.start.sensors[sensor].name};
  if (const std::uint32_t next = sensor + 1 < sensors ? frame : frame + 1; next < frames_.end)
    part.next_s = setup_.frames.time_s(next);
  return part;
}

std::vector<std::string> FrameSequence::paths() const {
  std::vector<std::string> paths;
  for (const FrameRecord &frame : run_.frames)
    for (const std::string &name : frame.outputs)
      paths.push_back(path_of(name));
  paths.push_back(path_of(manifest_name));
  return paths;
}

std::string FrameSequence::written_text() const {
  std::string text = "written:\n";
  for (const FrameRecord &frame : run_.frames)
    if (frame.frame == frames_.first)
      for (const std::string &name : frame.outputs)
        text += fmt::format("  {}\n", path_of(name));
  if (frames_.count() > 2)
    text += fmt::format("  and the same of frames {} to {}\n", frames_.first + 1, frames_.end - 1);
  else if (frames_.count() == 2)
    text += fmt::format("  and the same of frame {}\n", frames_.first + 1);
  return text + fmt::format("  {}\n", path_of(manifest_name));
}

} // namespace pmdsim
