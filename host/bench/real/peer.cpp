#include "host/bench/real/peer.h"

#include "engine/model/error.h"
#include "host/capture/progress.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace pmdsim {
namespace {

[[noreturn]] void fail(const Peer &peer, const std::string &what) {
  throw Error(ExitCode::input, fmt::format("{}: {}", peer.program.string(), what));
}

// All that comes until the end of the pipe.
std::string read_all(int from) {
  std::string output;
  std::array<char, 4096> text;
  for (ssize_t count = 1; count > 0 || (count < 0 && errno == EINTR);) {
    count = ::read(from, text.data(), text.size());
    if (count > 0)
      output.append(text.data(), static_cast<std::size_t>(count));
  }
  return output;
}

// Both streams of the program.
std::string output_of(const Peer &peer, std::vector<std::string> words) {
  std::vector<char *> arguments;
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> ends{}; // of a pipe
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    fail(peer, "cannot be run: no pipe");
  posix_spawn_file_actions_t streams;
  ::posix_spawn_file_actions_init(&streams);
  ::posix_spawn_file_actions_adddup2(&streams, ends[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&streams, ends[1], STDERR_FILENO);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, arguments.front(), &streams, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&streams);
  ::close(ends[1]);
  const std::string output = error == 0 ? read_all(ends[0]) : std::string();
  ::close(ends[0]);
  int status = 0;
  if (error != 0 || ::waitpid(child, &status, 0) != child)
    fail(peer, fmt::format("cannot be run: {}", std::generic_category().message(error)));
  throw_if_interrupted();
  if (status != 0)
    fail(peer, fmt::format("failed: {}", output.substr(0, output.find('\n'))));
  return output;
}

} // namespace

double last_frame_ms(const Peer &peer, const SceneFiles &files, const Sensor &sensor, int count) {
  const auto text = [](auto value) { return fmt::format("{}", value); };
  const std::string output =
      output_of(peer, {peer.program.string(), files.scene.string(), files.diodes.string(), "--res",
                       text(sensor.resolution.x), text(sensor.resolution.y), "--fov-x-tan",
                       text(half_view_tangent), "--freq", text(sensor.modulation_hz.front()), "--shadows",
                       "--threads", text(peer.threads), "--reps", text(count)});
  constexpr std::string_view key = "frame_ms ";
  const std::size_t at = std::string_view(output).rfind(key);
  double ms = 0.0;
  if (at != std::string::npos)
    std::from_chars(output.data() + at + key.size(), output.data() + output.size(), ms);
  if (!(ms > 0.0))
    fail(peer, "printed no time of a frame; expected a line with \"frame_ms\" and a number");
  return ms;
}

} // namespace pmdsim
