#include "host/commands/frame_sequence.h"

#include "engine/error.h"
#include "host/commands/interruption.h"
#include "host/commands/report.h"

#include <fmt/format.h>
#include <utility>

namespace pmdsim {
namespace {

void add_manifest(OutputSet &files, const RunRecord &run) {
  files.add(manifest_name, [&](OutputFile &file) { write_manifest(file, run); });
}

std::string whole_text(const std::vector<FrameRecord> &frames) {
  const std::uint32_t first = frames.front().frame, last = frames.back().frame;
  return first == last ? fmt::format("frame {} is whole and stays", first)
                       : fmt::format("frames {} to {} are whole and stay", first, last);
}

} // namespace

FrameRange frames_of(const Options &options, const Setup &setup) {
  const FrameRange frames = options.frames.value_or(FrameRange{0, setup.frames.count});
  if (frames.end > setup.frames.count)
    throw Error(ExitCode::usage,
                fmt::format("--frames {}:{}: expected B at most {}, the frames of {}", frames.first,
                            frames.end, setup.frames.count, setup.file.string()));
  return frames;
}

FrameSequence::FrameSequence(const Setup &setup, const FrameRange &frames,
                             const std::filesystem::path &directory, RunRecord run)
    : setup_(setup), frames_(frames), files_(std::make_unique<OutputSet>(directory)),
      directory_(files_->directory()), run_(std::move(run)) {}

void FrameSequence::write(const Write &write_sensor) {
  const auto write_frames = [&] {
    for (std::uint32_t frame = frames_.first; frame < frames_.end; ++frame)
      write_frame(frame, write_sensor);
  };
  try {
    write_frames();
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

void FrameSequence::write_frame(std::uint32_t frame, const Write &write_sensor) {
  if (!files_)
    files_ = std::make_unique<OutputSet>(directory_);
  for (const SensorFrame &at : sensors_of(frame)) {
    const std::size_t first_output = files_->names().size();
    run_.frames.push_back(write_sensor(at, *files_));
    run_.frames.back().outputs = files_->names_from(first_output);
  }
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

std::vector<SensorFrame> FrameSequence::sensors_of(std::uint32_t frame) const {
  const std::string label = frames_.count() > 1
                                ? fmt::format("frame {}/{}, ", frame - frames_.first + 1, frames_.count())
                                : "measuring ";
  std::vector<SensorFrame> sensors;
  for (std::size_t i = 0; i < setup_.start.sensors.size(); ++i)
    sensors.push_back({frame, setup_.frames.time_s(frame), i, label + setup_.start.sensors[i].name});
  return sensors;
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
