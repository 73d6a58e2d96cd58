#include "host/output/run/run_identity.h"

#include "engine/model/error.h"
#include "host/output/files/manifest.h"

#include <algorithm>
#include <array>
#include <climits>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <unistd.h>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;
using Pointer = ordered_json::json_pointer;

// Where the two differ first, in the order of `here`.
std::optional<Pointer> first_difference(const ordered_json &there, const ordered_json &here,
                                        const Pointer &at = Pointer()) {
  if (there == here)
    return std::nullopt;
  if (there.is_array() && here.is_array() && there.size() == here.size())
    for (std::size_t i = 0; i < here.size(); ++i)
      if (const auto found = first_difference(there[i], here[i], at / i))
        return found;
  if (there.is_object() && here.is_object()) {
    for (const auto &[key, value] : here.items())
      if (!there.contains(key) || there.at(key) != value)
        return there.contains(key) ? first_difference(there.at(key), value, at / key) : at / key;
    for (const auto &[key, value] : there.items())
      if (!here.contains(key))
        return at / key;
  }
  return at;
}

std::string short_text(const ordered_json &json, const Pointer &at) {
  constexpr std::size_t longest = 60;
  if (!json.contains(at))
    return "nothing";
  std::string text = json.at(at).dump(-1, ' ', true, ordered_json::error_handler_t::replace);
  if (text.size() > longest)
    text = text.substr(0, longest) + "...";
  return text;
}

std::string input_difference(const ordered_json &there, const ordered_json &here) {
  for (const ordered_json &input : here) {
    const auto same_name = [&](const ordered_json &other) { return other.at("file") == input.at("file"); };
    const auto found = std::ranges::find_if(there, same_name);
    if (found == there.end() || *found != input)
      return fmt::format("the input file {} {}", input.at("file").get<std::string>(),
                         found == there.end() ? "was not read there" : "has changed");
  }
  return "the input files differ";
}

} // namespace

Beginner this_process() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0)
    name = {"unknown"};
  return {name.data(), ::getpid()};
}

std::string run_file_text(const RunIdentity &run, const Beginner &beginner) {
  ordered_json json = run.head;
  json["run"] = run.hash;
  json["begun_by"] = {{"host", beginner.host}, {"process", beginner.process}};
  return json_text(json);
}

std::optional<RunFile> parsed_run_file(const std::string &text) {
  try {
    ordered_json json = ordered_json::parse(text);
    const ordered_json begun = json.at("begun_by");
    RunFile file{{{}, json.at("run")}, {begun.at("host"), begun.at("process")}};
    json.erase("run");
    json.erase("begun_by");
    file.run.head = std::move(json);
    return file;
  } catch (const nlohmann::json::exception &) {
    return std::nullopt;
  }
}

RunFile read_run_file(const std::filesystem::path &folder) {
  const std::filesystem::path file = folder / run_file_name;
  std::ifstream in(file, std::ios::binary);
  const auto found = parsed_run_file({std::istreambuf_iterator<char>(in), {}});
  if (!found)
    throw Error(ExitCode::input,
                fmt::format("{}: {}, expected what render or deform leaves beside its frames", file.string(),
                            in ? "is not a run's file" : "cannot be read"));
  return *found;
}

std::string difference_text(const RunIdentity &there, const RunIdentity &here) {
  const auto found = first_difference(there.head, here.head);
  if (!found || found->empty())
    return "its hash differs";
  std::string pointer = found->to_string();
  const std::string key = pointer.substr(1, pointer.find('/', 1) - 1);
  if (key == "inputs" && there.head.contains(key) && here.head.contains(key))
    return input_difference(there.head.at(key), here.head.at(key));
  const std::string values =
      fmt::format("{} there, {} here", short_text(there.head, *found), short_text(here.head, *found));
  if (key == "setup")
    return fmt::format("the setup differs at {}: {}", pointer.substr(1 + key.size()), values);
  return fmt::format("its {} differs: {}", key, values);
}

} // namespace pmdsim
