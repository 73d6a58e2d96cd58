#include "host/bench/real/peer.h"

#include "engine/model/error.h"
#include "host/capture/progress.h"

#include <cerrno>
#include <charconv>
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

[[noreturn]] void fail(const std::filesystem::path &program, const std::string &what) {
  throw Error(ExitCode::input, fmt::format("{}: {}", program.string(), what));
}

// Both streams of a program that has ended, and how.
struct Ended {
  std::string output;
  int status;
};

Ended run(std::vector<std::string> words) {
  std::vector<char *> arguments;
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    fail(words[0], std::generic_category().message(errno));
  posix_spawn_file_actions_t streams;
  ::posix_spawn_file_actions_init(&streams);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_adddup2(&streams, ends[1], stream);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, arguments[0], &streams, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&streams);
  ::close(ends[1]);
  Ended ended{{}, 0};
  char text[4096];
  for (ssize_t count = 0; error == 0 && (count = ::read(ends[0], text, sizeof text)) != 0;)
    if (count > 0)
      ended.output.append(text, static_cast<std::size_t>(count));
  ::close(ends[0]);
  if (error != 0)
    fail(words[0], fmt::format("cannot be run: {}", std::generic_category().message(error)));
  while (::waitpid(child, &ended.status, 0) < 0 && errno == EINTR)
    ;
  throw_if_interrupted();
  return ended;
}

} // namespace

double last_frame_ms(const Peer &peer, const SceneFiles &files, const Sensor &sensor, int count) {
  const Ended ended =
      run({peer.program.string(), files.scene.string(), files.diodes.string(), "--res",
           fmt::format("{}", sensor.resolution.x), fmt::format("{}", sensor.resolution.y), "--fov-x-tan",
           fmt::format("{}", half_view_tangent), "--freq", fmt::format("{}", sensor.modulation_hz.front()),
           "--shadows", "--threads", fmt::format("{}", peer.threads), "--reps", fmt::format("{}", count)});
  if (!WIFEXITED(ended.status) || WEXITSTATUS(ended.status) != 0)
    fail(peer.program, fmt::format("failed on {}", files.scene.string()));
  constexpr std::string_view key = "frame_ms ";
  const std::size_t at = ended.output.rfind(key);
  double ms = 0.0;
  if (at == std::string::npos ||
      std::from_chars(ended.output.data() + at + key.size(), ended.output.data() + ended.output.size(), ms)
              .ec != std::errc() ||
      !(ms > 0.0))
    fail(peer.program, "printed no time of a frame; expected a line with \"frame_ms\" and a number");
  return ms;
}

} // namespace pmdsim
