#include "host/bench/real/peer.h"

#include "engine/model/error.h"
#include "host/capture/progress.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace pmdsim {
namespace {

// As the shell takes it for one word, whatever is in it.
std::string quoted(const std::filesystem::path &path) {
  std::string word;
  for (const char c : path.string())
    word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + word + "'";
}

[[noreturn]] void fail(const Peer &peer, const std::string &what) {
  throw Error(ExitCode::input, fmt::format("{}: {}", peer.program.string(), what));
}

// Both streams of the command.
std::string output_of(const Peer &peer, const std::string &command) {
  std::FILE *stream = ::popen((command + " 2>&1").c_str(), "r");
  if (!stream)
    fail(peer, "cannot be run");
  std::string output;
  std::array<char, 4096> text;
  while (const std::size_t count = std::fread(text.data(), 1, text.size(), stream))
    output.append(text.data(), count);
  const int status = ::pclose(stream);
  throw_if_interrupted();
  if (status != 0)
    fail(peer, fmt::format("failed: {}", output.substr(0, output.find('\n'))));
  return output;
}

} // namespace

double last_frame_ms(const Peer &peer, const SceneFiles &files, const Sensor &sensor, int count) {
  const std::string output = output_of(
      peer,
      fmt::format("{} {} {} --res {} {} --fov-x-tan {} --freq {} --shadows --threads {} --reps {}",
                  quoted(peer.program), quoted(files.scene), quoted(files.diodes), sensor.resolution.x,
                  sensor.resolution.y, half_view_tangent, sensor.modulation_hz.front(), peer.threads, count));
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
