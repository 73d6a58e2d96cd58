#pragma once
// The frames that a command leaves in a directory: each whole, all its sensors' files at once, in order, and
// a manifest of those that are there. While frames are written the next are measured.

#include "host/input/setup/setup.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

inline constexpr const char *manifest_name = "manifest.json";

// Frames `first` to `end` - 1.
struct FrameRange {
  std::uint32_t first = 0, end = 1;

  std::uint32_t count() const { return end - first; }
};

// One sensor's part of a frame.
struct SensorFrame {
  std::uint32_t frame; // its number in the setup
  double time_s;
  std::size_t sensor;             // its index in the setup
  std::string label;              // for people: "frame 3/20, pmd"
  std::optional<double> next_s{}; // when the frame of the part after this one begins, if there is one
};

// A measured part of a frame.
struct MeasuredPart {
  FrameRecord record; // `outputs` aside
  // Gives the files to write, once; holds the measurement, or shares it.
  std::function<std::vector<FileToWrite>()> files;
};

// How many such parts may wait to be written while the next is measured, each of `part_bytes`: as many as
// keep the processor busy, and no more than fit into 1 GiB; none where a single one does not fit.
std::size_t parts_waiting(std::size_t part_bytes);

class FrameSequence {
public:
  // `run` is without frames yet. Creates the directory. Throws Error (output) where that fails or nothing
  // can be written there.
  FrameSequence(const Setup &setup, const FrameRange &frames, const std::filesystem::path &directory,
                RunRecord run);

  using Measure = std::function<MeasuredPart(const SensorFrame &)>;
  // Measures frame by frame, and sensor by sensor in each, one at a time though not always on the same
  // thread, and writes the parts on threads of its own; `part_bytes` is what the largest part holds. Where
  // either fails, Error (interrupted) among others, whole frames stay with a manifest that lists just these;
  // without any, nothing stays.
  void write(const Measure &measure, std::size_t part_bytes);

  const RunRecord &run() const { return run_; }
  // A name with the directory in front.
  std::string path_of(const std::string &name) const { return (directory_ / name).string(); }
  // The paths of all files, the manifest last.
  std::vector<std::string> paths() const;
  // "written:" and the paths below it, those of the first frame for all.
  std::string written_text() const;

private:
  // Written under temporary names.
  struct WrittenPart {
    FrameRecord record;
    WrittenFiles files;
  };

  void write_all(const Measure &measure, std::size_t part_bytes);
  SensorFrame part(std::size_t index) const;
  void add(const SensorFrame &at, WrittenPart part);
  void publish(std::uint32_t frame);
  bool keep_whole_frames() noexcept;

  const Setup &setup_;
  FrameRange frames_;
  std::unique_ptr<OutputSet> files_; // of the frame that is published next
  std::filesystem::path directory_;
  RunRecord run_;
  std::size_t whole_ = 0; // of the run's frames, those that are published
};

} // namespace pmdsim
