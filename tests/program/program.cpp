#include "tests/program/program.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace pmdsim::test {
namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr unsigned longest_run_s = 1200;
#else
constexpr unsigned longest_run_s = 60;
#endif

std::string content(const fs::path &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void redirect(const fs::path &file, int to) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (descriptor < 0 || ::dup2(descriptor, to) < 0)
    ::_exit(126);
}

// In the child, between fork and exec.
[[noreturn]] void become_program(const std::vector<std::string> &arguments, const RunOptions &options,
                                 const fs::path &output, const fs::path &errors) {
  redirect(output, STDOUT_FILENO);
  redirect(errors, STDERR_FILENO);
  for (const auto &[name, value] : options.environment)
    ::setenv(name.c_str(), value.c_str(), 1);
  if (::chdir(options.directory.c_str()) != 0)
    ::_exit(126);
  std::vector<char *> pointers{const_cast<char *>(PMDSIM_PROGRAM)};
  for (const std::string &argument : arguments)
    pointers.push_back(const_cast<char *>(argument.c_str()));
  pointers.push_back(nullptr);
  if (options.ignored != 0)
    ::signal(options.ignored, SIG_IGN);
  ::alarm(longest_run_s);
  ::execv(PMDSIM_PROGRAM, pointers.data());
  ::_exit(126);
}

// A signal that comes before the program has begun ends the child, and does not meet the handlers of the
// tests there, which wait for ever where the parent was within malloc().
pid_t fork_without_handlers() {
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t process = ::fork();
  if (process == 0)
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
      ::signal(signal, SIG_DFL);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return process;
}

// The most memory that a process has had so far, or nothing where it has ended. Its rusage is no measure:
// that begins with the memory of the test that forked it.
std::optional<std::int64_t> peak_resident_bytes(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string word; status >> word;)
    if (std::int64_t kibibytes = 0; word == "VmHWM:" && status >> kibibytes)
      return kibibytes * 1024;
  return std::nullopt;
}

} // namespace

void wait_for(const fs::path &file) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(longest_run_s);
  while (!fs::exists(file) && std::chrono::steady_clock::now() < give_up)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

RunningPmdsim::RunningPmdsim(const std::vector<std::string> &arguments, const RunOptions &options)
    : process_(fork_without_handlers()) {
  if (process_ < 0)
    throw std::runtime_error("fork failed");
  if (process_ == 0)
    become_program(arguments, options, streams_.path() / "stdout", streams_.path() / "stderr");
}

RunningPmdsim::~RunningPmdsim() {
  if (process_ == 0)
    return;
  send(SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void RunningPmdsim::send(int signal) const { ::kill(process_, signal); }

Run RunningPmdsim::wait() {
  int status = 0;
  std::int64_t peak_bytes = 0;
  for (pid_t ended = 0; ended == 0;) {
    peak_bytes = peak_resident_bytes(process_).value_or(peak_bytes);
    ended = ::waitpid(process_, &status, WNOHANG);
    if (ended < 0)
      throw std::runtime_error("waitpid failed");
    if (ended == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  process_ = 0;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          content(streams_.path() / "stdout"), content(streams_.path() / "stderr"), peak_bytes};
}

Run run_pmdsim(const std::vector<std::string> &arguments, const RunOptions &options) {
  RunningPmdsim program(arguments, options);
  if (options.interrupt_after_ms > 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(options.interrupt_after_ms));
    program.send(options.signal);
  } else if (!options.interrupt_when.empty()) {
    wait_for(options.interrupt_when);
    program.send(options.signal);
  }
  return program.wait();
}

std::vector<std::string> Workspace::files(const std::string &below) const {
  std::vector<std::string> names;
  const fs::path root = path() / below;
  if (fs::exists(root))
    for (const auto &entry : fs::recursive_directory_iterator(root))
      if (!entry.is_directory())
        names.push_back(fs::relative(entry.path(), root).string());
  std::ranges::sort(names);
  return names;
}

std::string scene(const std::string &name) { return std::string(PMDSIM_SCENES) + "/" + name; }

std::string small_setup(const std::string &scene_file) {
  return R"({
  "scene": ")" +
         scene_file + R"(",
  "backscatter": "constant",
  "sensors": [{
    "name": "pmd",
    "resolution": [8, 8],
    "pixel_pitch_m": [45e-6, 45e-6],
    "focal_length_m": 0.0018,
    "modulation_hz": [20e6]
  }],
  "illuminators": [{
    "name": "ring",
    "pose": {"sensor": "pmd"},
    "diodes": {"rings": [{"radius_m": 0.146, "count": 16}]}
  }]
})";
}

std::string opencv_calibration() {
  return R"(%YAML:1.0
---
image_width: 12
image_height: 8
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 40., 0., 5.75, 0., 41., 3.25, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.1, 0.02, 0.001, -0.002, 0. ]
)";
}

std::string wall_gltf() {
  // Four corners (float32 x, y, z): (-0.2, -0.2, -2), (0.2, -0.2, -2), (0.2, 0.2, -2), (-0.2, 0.2, -2);
  // indices 0 1 2 0 2 3 as bytes.
  return R"({
  "asset": {"version": "2.0"},
  "scene": 0,
  "scenes": [{"nodes": [0]}],
  "nodes": [{"name": "wall", "mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-0.2, -0.2, -2], "max": [0.2, 0.2, -2]},
    {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"}
  ],
  "bufferViews": [
    {"buffer": 0, "byteOffset": 0, "byteLength": 48},
    {"buffer": 0, "byteOffset": 48, "byteLength": 6}
  ],
  "buffers": [{"byteLength": 54, "uri": "data:application/octet-stream;base64,zcxMvs3MTL4AAADAzcxMPs3MTL4AAADAzcxMPs3MTD4AAADAzcxMvs3MTD4AAADAAAECAAID"}]
})";
}

std::string with(std::string text, const std::string &from, const std::string &to) {
  const auto at = text.find(from);
  if (at == std::string::npos)
    throw std::logic_error("'" + from + "' is not in the text");
  return text.replace(at, from.size(), to);
}

} // namespace pmdsim::test
