#include "host/command_line/setup_options.h"

#include "engine/model/error.h"
#include "host/input/file/input_error.h"
#include "host/input/file/json_file.h"

#include <CLI/CLI.hpp>

namespace pmdsim {

using nlohmann::json;

void add_setups(CLI::App &command, WrittenSetups &written, Setups setups) {
  CLI::Option *files = command.add_option("SETUP", written.setups, "setup file (JSON)");
  if (setups != Setups::none_or_one)
    files->required();
  if (setups == Setups::one)
    files->expected(1)->allow_extra_args(false); // what follows is another operand
  if (setups == Setups::none_or_one)
    files->expected(0, 1);
  command
      .add_option("--set", written.changes,
                  "PATH=VALUE, changes the setup, e.g. sensors/0/modulation_hz=[30e6]; null takes the key "
                  "out; may be "
                  "given several times")
      ->allow_extra_args(false);
  command.add_option(
      "--poses", written.poses,
      "[NAME=]FILE, the sensor, illuminator or node NAME, or the first sensor, moves along the poses of "
      "a file (TUM, CSV or ROS), with a frame at each");
  command.add_flag(allow_outside_option, written.allow_outside,
                   "files that the scene names may lie outside of its folder: for scenes that you trust");
  if (setups == Setups::several)
    command.add_option("--variants", written.variants,
                       "file of JSON Lines: for each line a variant with the changes {\"PATH\": VALUE, ...}");
}

json changes_of(const std::vector<std::string> &written) {
  json changes = json::object();
  for (const std::string &text : written) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ExitCode::usage, "--set: expected PATH=VALUE, found " + in_quotes(text));
    const std::size_t begin = text.front() == '/' ? 1 : 0; // a path is the same with and without
    const std::string path = text.substr(begin, equals - begin), value = text.substr(equals + 1);
    if (changes.contains(path))
      throw Error(ExitCode::usage,
                  "--set: expected one value for each path, found two for " + in_quotes(path));
    try {
      changes[path] = parse_json(value, "--set", Comments::refused);
    } catch (const Error &) { // text need not be quoted; what it should have been, the schema says
      changes[path] = value;
    }
  }
  return changes;
}

PosesFromFile poses_of(const std::string &written) {
  const std::size_t equals = written.find('=');
  const bool is_named = equals != std::string::npos;
  PosesFromFile poses{is_named ? written.substr(0, equals) : "",
                      is_named ? written.substr(equals + 1) : written};
  if (poses.file.empty() || (is_named && poses.name.empty()))
    throw Error(ExitCode::usage, "--poses: expected FILE or NAME=FILE, found " + in_quotes(written));
  return poses;
}

} // namespace pmdsim
