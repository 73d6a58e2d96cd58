#pragma once
// The frames that a command leaves in a directory: each whole, all its sensors' files at once and then its
// record, in order, and a manifest of those that are there. While frames are written the next are measured.
// Several processes may do that in one directory at once (host/output/run/run_folder.h); each frame is made
// by one of them.

#include "host/input/setup/setup.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"
#include "host/output/run/run_folder.h"

#include <chrono>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// One sensor's part of a frame.
struct SensorFrame {
  std::uint32_t frame; // its number in the setup
  double time_s;
  std::size_t sensor; // its index in the setup
  std::string label;  // for people: "frame 3/20, pmd"
  std::optional<double>
      next_s{}; // when the frame of the part after this one most likely begins, if there is one
  std::uint32_t frames_done = 0; // of those that were to be made at the start, by whichever process
  bool is_in_sheets = false;     // pictures of the whole run show the frame
};

// A measured part of a frame.
struct MeasuredPart {
  FrameRecord record; // `outputs` aside
  // Gives the files to write, once; holds the measurement, or shares it. May complete the record.
  std::function<std::vector<FileToWrite>(FrameRecord &)> files;
};

// How many such parts may wait to be written while the next is measured, each of `part_bytes`: as many as
// keep the processor busy, and no more than fit into 1 GiB and into the `room` that is left for them; none
// where a single one does not fit.
std::size_t parts_waiting(std::size_t part_bytes, std::uint64_t room = UINT64_MAX);

// What is asked of a sequence.
struct SequenceRequest {
  FrameRange frames{};
  std::filesystem::path directory;
  RunFolder::Earlier earlier = RunFolder::Earlier::made_again; // frames of an earlier run that was the same
  bool strict = false; // a frame that is there counts only if it has no warning
};

class FrameSequence {
public:
  // `setup` must outlive it.
  FrameSequence(const Setup &setup, SequenceRequest request, const RunHead &run);

  // Enters the directory; how many frames are to be made. Once, and before write(). Throws Error as
  // RunFolder, or (interrupted).
  std::uint32_t begin();

  using Measure = std::function<MeasuredPart(const SensorFrame &)>;
  // Measures those frames that no other process makes, frame by frame, and sensor by sensor in each, one at a
  // time though not always on the same thread, and writes the parts on threads of its own; `part_bytes` is
  // what the largest part holds, and those that wait to be written have `room`. A frame gets its names once
  // the disk has it, with those of the half second before; one that ends sooner after those, with the next
  // one. Then waits for the others'. Where any of that fails, Error (interrupted) among others, whole frames
  // stay with a manifest that lists just these; without any, nothing stays.
  void write(const Measure &measure, std::size_t part_bytes, std::uint64_t room = UINT64_MAX);

  const RunHead &run() const { return run_; }
  // The record of each frame that was asked for, in order, whoever made it. Throws Error (output) where one
  // is missing, (input) where one has been edited so that `use` misses something.
  void for_each_record(const std::function<void(const nlohmann::ordered_json &)> &use) const;
  const std::filesystem::path &path() const { return request_.directory; }
  // A name with the directory in front.
  std::string path_of(const std::string &name) const { return (request_.directory / name).string(); }
  // The names of pictures of the whole run, where this process has made them.
  const std::vector<std::string> &sheets() const { return sheets_; }
  // "written:" and the paths below it, those of the first frame that this process made for all.
  std::string written_text() const;

private:
  // Written under temporary names.
  struct WrittenPart {
    SensorFrame at;
    FrameRecord record;
    WrittenFiles files;
  };
  // A frame whose files are written and have no names yet.
  struct Finished {
    explicit Finished(const std::filesystem::path &directory) : files(directory) {}

    OutputSet files;
    std::vector<FrameRecord> parts{};
  };
  // Frames that this process has published.
  struct Made {
    std::uint32_t first = 0, last = 0, count = 0;
    bool in_a_row = true;
    std::vector<std::string> names_of_first{};
  };

  void make_all(const Measure &measure, std::size_t waiting);
  bool make_free_ones(const Measure &measure, std::size_t waiting);
  std::optional<std::uint32_t> claim_next();
  SensorFrame part(std::uint32_t frame, std::size_t sensor) const;
  std::optional<std::uint32_t> next_after(std::uint32_t frame) const;
  void add(WrittenPart part);
  void finish_frame();
  void publish(Finished &frame);
  void publish_finished();
  void keep_finished() noexcept;
  std::string whole_text() const;
  std::size_t sensor_count() const { return setup_.start.sensors.size(); }

  const Setup &setup_;
  SequenceRequest request_;
  RunHead run_;
  std::optional<RunFolder> folder_;         // once it has begun
  std::deque<std::uint32_t> to_do_, taken_; // by this process, as far as is known; by others
  std::uint32_t to_do_at_start_ = 0;
  WrittenFiles files_;                             // of the frame that is published next, and
  std::vector<FrameRecord> parts_;                 // its sensors' records
  std::deque<std::unique_ptr<Finished>> finished_; // that wait for the disk
  std::chrono::steady_clock::time_point synced_{};
  Made made_;
  std::vector<std::string> sheets_;
};

} // namespace pmdsim
