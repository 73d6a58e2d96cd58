#pragma once
// The folder of a run, in which several processes may measure frames of the same run at once:
//   run.json         what the run is; its bytes are locked, never read, to agree about the folder
//   N.record.json    frame N is whole; comes after the frame's other files
//   manifest.json    made from the two, by every process as it ends
// Each process that lives in the folder shares a lock; who holds it alone may begin another run there, and
// knows that the temporary files of the folder are those of the dead.

#include "engine/model/warning.h"
#include "host/output/files/output_directory.h"
#include "host/output/files/output_set.h"
#include "host/output/run/byte_locks.h"
#include "host/output/run/frame_range.h"
#include "host/output/run/frame_records.h"
#include "host/output/run/run_identity.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace pmdsim {

class RunFolder {
public:
  // What shall happen to `frames` that the folder has already of the same run. Those that other processes
  // make meanwhile are never made again.
  enum class Earlier { made_again, kept };
  // Creates the directory and begins the run there, or joins those that are at it. Where nobody else is, an
  // earlier run of another kind goes, its records and its manifest, unless the earlier frames are to be kept.
  // `wait` is called while another process is about to begin or writes the manifest; what it throws comes
  // out. `strict`: a frame that has warnings is not whole. Throws Error: (input) where frames of
  // another run, or variants, are to be kept; (output) where others are at another run there, or nothing can
  // be written.
  RunFolder(const std::filesystem::path &directory, RunIdentity run, const FrameRange &frames,
            Earlier earlier, std::function<void()> wait, bool strict = false);
  // Of a folder that has a run, to make its manifest again. Throws Error (input) where it has none.
  static RunFolder of_existing(const std::filesystem::path &directory, const std::function<void()> &wait);
  // Leaves nothing where no frame is whole, unless a manifest says so.
  ~RunFolder();
  RunFolder(const RunFolder &) = delete;
  RunFolder &operator=(const RunFolder &) = delete;

  const std::filesystem::path &path() const { return directory_.path(); }
  const RunIdentity &run() const { return run_; }
  bool is_joined() const { return joined_; }         // others were there
  bool has_locks() const { return locks_->works(); } // else this process must be the only one
  // Of frames of an earlier run of another kind that `frames` do not reach: their files stay, and nothing
  // tells of them any more. Nothing where there are none.
  std::optional<Warning> left_warning() const;
  // The frame's record, where it is whole.
  std::optional<nlohmann::ordered_json> whole(std::uint32_t frame) const;

  // granted: it is this process's to publish or to give back. taken: another process's.
  enum class Claim { granted, whole, taken };
  Claim claim(std::uint32_t frame);
  void give_back(std::uint32_t frame);
  // Whether claim() would most likely be granted.
  bool seems_free(std::uint32_t frame) const;

  // Writes the record of a frame beside its other files, which have no names yet.
  static void add_record(OutputSet &files, const nlohmann::ordered_json &record);
  // Gives the files their names, and then the record, of a frame that was granted. The disk has them.
  void publish(OutputSet &files, std::uint32_t frame);

  // From the records that are there. Of how many frames. Throws Error (output), or what `wait` throws.
  std::size_t write_manifest();
  // The same where a run ends early and some frames are whole. False where that fails.
  bool keep_whole_frames() noexcept;

private:
  bool enter(const FrameRange &frames, Earlier earlier);
  bool enter_alone(ByteLocks there, const FrameRange &frames, Earlier earlier);
  bool enter_beside_others(ByteLocks there);
  std::optional<ByteLocks> new_run_file(bool replacing) const;
  void settle(ByteLocks mine);
  void clear(bool same_run, const FrameRange &frames, Earlier earlier);
  void remove_leftovers() const;
  void lock_manifest(const std::function<void()> &wait);
  std::size_t write_manifest(const std::function<void()> &wait);
  void leave();

  OutputDirectory directory_;
  RunIdentity run_;
  std::function<void()> wait_;
  bool strict_;
  std::optional<ByteLocks> locks_; // of run.json
  bool joined_ = false, has_manifest_ = false;
  // Of that earlier run.
  struct Left {
    std::size_t frames = 0;
    std::string difference{}; // from this one
  };
  Left left_;
};

} // namespace pmdsim
