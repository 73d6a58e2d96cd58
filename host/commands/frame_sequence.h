#pragma once
// The frames that a command leaves in a directory: each whole, all its sensors' files at once, as soon as it
// is measured, and a manifest of those that are there.

#include "host/input/setup.h"
#include "host/options.h"
#include "host/output/manifest.h"
#include "host/output/output_set.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pmdsim {

inline constexpr const char *manifest_name = "manifest.json";

// Those that the command line asks for, else all of the setup's. Throws Error (usage) where the setup has
// not so many.
FrameRange frames_of(const Options &options, const Setup &setup);

// One sensor's part of a frame.
struct SensorFrame {
  std::uint32_t frame; // its number in the setup
  double time_s;
  std::size_t sensor; // its index in the setup
  std::string label;  // for people: "frame 3/20, pmd"
};

class FrameSequence {
public:
  // `run` is without frames yet. Creates the directory. Throws Error (output) where that fails or nothing
  // can be written there.
  FrameSequence(const Setup &setup, const FrameRange &frames, const std::filesystem::path &directory,
                RunRecord run);

  // Writes one sensor's files into the set and tells what it wrote, `outputs` aside.
  using Write = std::function<FrameRecord(const SensorFrame &, OutputSet &)>;
  // Frame by frame, and sensor by sensor in each. Where that fails, Error (interrupted) among others, whole
  // frames stay with a manifest that lists just these; without any, nothing stays.
  void write(const Write &write_sensor);

  const RunRecord &run() const { return run_; }
  // A name with the directory in front.
  std::string path_of(const std::string &name) const { return (directory_ / name).string(); }
  // Of all files, the manifest last.
  std::vector<std::string> paths() const;
  // "written:" and the paths below it, those of the first frame for all.
  std::string written_text() const;

private:
  void write_frame(std::uint32_t frame, const Write &write_sensor);
  std::vector<SensorFrame> sensors_of(std::uint32_t frame) const;
  bool keep_whole_frames() noexcept;

  const Setup &setup_;
  FrameRange frames_;
  std::unique_ptr<OutputSet> files_; // of the frame at hand
  std::filesystem::path directory_;
  RunRecord run_;
  std::size_t whole_ = 0; // of the run's frames, those that are published
};

} // namespace pmdsim
