#pragma once
// The real binary, run as a user runs it.

#include "tests/support/temporary_folder.h"

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pmdsim::test {

struct Run {
  int exit_code = -1; // 128 + n where signal n ended it
  std::string output; // stdout
  std::string errors; // stderr
  std::int64_t peak_resident_bytes = 0;
};

struct RunOptions {
  std::map<std::string, std::string> environment{}; // beside the test's own
  std::filesystem::path directory = ".";            // the process's working directory
  int signal = SIGINT;                              // what interrupts it
  int interrupt_after_ms = 0;                       // then; 0: never
  std::filesystem::path interrupt_when{};           // as soon as this exists; empty: never
  int ignored = 0;                                  // a signal that it ignores from the start, as nohup does
};

// Ends the program after a minute: a hang is an exit code of 128 + SIGALRM.
Run run_pmdsim(const std::vector<std::string> &arguments, const RunOptions &options = {});

// The program while it runs beside the test, which ends it where the test does not wait.
class RunningPmdsim {
public:
  explicit RunningPmdsim(const std::vector<std::string> &arguments, const RunOptions &options = {});
  ~RunningPmdsim();
  RunningPmdsim(const RunningPmdsim &) = delete;
  RunningPmdsim &operator=(const RunningPmdsim &) = delete;

  void send(int signal) const;
  Run wait(); // once

private:
  TemporaryFolder streams_;
  int process_; // 0: has ended
};

// Waits until it exists, at most a minute.
void wait_for(const std::filesystem::path &file);

// A temporary folder with the setups and the outputs of a test.
class Workspace {
public:
  const std::filesystem::path &path() const { return folder_.path(); }
  std::string operator/(const std::string &name) const { return (path() / name).string(); }
  // Writes `text` to the file and returns its path.
  std::string write(const std::string &name, const std::string &text) const {
    return folder_.write(name, text).string();
  }
  // The names of all files below, sorted.
  std::vector<std::string> files(const std::string &below = ".") const;

private:
  TemporaryFolder folder_;
};

// A scene from the repository's scenes/.
std::string scene(const std::string &name);

// A setup that works: a wall of `scene_file` (written by the test into the same folder) seen by 8 x 8 pixels.
std::string small_setup(const std::string &scene_file = "wall.gltf");
// That wall: 0.4 x 0.4 m at 2 m.
std::string wall_gltf();
// A camera of 12 x 8 pixels as OpenCV's FileStorage writes it, with some distortion.
std::string opencv_calibration();
// `text` with `from`, which must be in it, replaced by `to`.
std::string with(std::string text, const std::string &from, const std::string &to);

} // namespace pmdsim::test
