#include "host/output/run/run_identity.h"

#include "engine/model/error.h"
#include "host/input/file/input_file.h"
#include "host/input/words/folder_names.h"
#include "host/output/files/manifest.h"
#include "host/output/run/run_json.h"

#include <algorithm>
#include <array>
#include <climits>
#include <fmt/format.h>
#include <map>
#include <string_view>
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

// As it may stand in a message, in one line.
std::string escaped(const std::string &text) {
  const std::string quoted = ordered_json(text).dump(-1, ' ', true, ordered_json::error_handler_t::replace);
  return quoted.substr(1, quoted.size() - 2);
}

std::string input_difference(const ordered_json &there, const ordered_json &here) {
  std::map<std::string_view, const ordered_json *> files; // the first one of each name
  for (const ordered_json &input : there)
    files.emplace(input.at("file").get_ref<const std::string &>(), &input);
  for (const ordered_json &input : here) {
    const auto &name = input.at("file").get_ref<const std::string &>();
    const auto found = files.find(name);
    if (found == files.end() || *found->second != input)
      return fmt::format("the input file {} {}", escaped(name),
                         found == files.end() ? "was not read there" : "has changed");
  }
  return "the input files differ";
}

bool has_folders_of_runs(const std::filesystem::path &folder) {
  std::error_code ignored;
  return std::ranges::any_of(names_in(folder, ignored), [&](const std::string &name) {
    return std::filesystem::exists(folder / name / run_file_name, ignored);
  });
}

// Objects with a file's name, or json::exception.
bool are_inputs(const ordered_json &inputs) {
  const auto names_file = [](const ordered_json &input) { return input.at("file").is_string(); };
  return inputs.is_array() && std::ranges::all_of(inputs, names_file);
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

std::optional<RunFile> parsed_run_file(const std::string &text, const std::filesystem::path &named) {
  try {
    std::optional<ordered_json> json = parsed_in_order(text, named);
    if (!json)
      return std::nullopt;
    const ordered_json begun = json->at("begun_by");
    if (!begun.at("process").is_number_integer() ||
        (json->contains("inputs") && !are_inputs(json->at("inputs"))))
      return std::nullopt;
    RunFile file{{{}, json->at("run")}, {begun.at("host"), begun.at("process")}};
    json->erase("run");
    json->erase("begun_by");
    file.run.head = std::move(*json);
    return file;
  } catch (const nlohmann::json::exception &) {
    return std::nullopt;
  }
}

RunFile read_run_file(const std::filesystem::path &folder) {
  const std::filesystem::path file = folder / run_file_name;
  const char *expected = has_folders_of_runs(folder)
                             ? "it holds variants; `render` with the same options, --resume and no --shard "
                               "gathers their table"
                             : "expected what render or deform leaves beside its frames";
  std::string text;
  try {
    text = read_regular_file(file, max_run_json_bytes, Place{file});
  } catch (const Error &error) {
    throw Error(error.code(), fmt::format("{}, {}", error.what(), expected));
  }
  const auto found = parsed_run_file(text, file);
  if (!found)
    throw input_error(Place{file}, fmt::format("is not a run's file, {}", expected));
  return *found;
}

std::string difference_text(const RunIdentity &there, const RunIdentity &here) {
  const auto found = first_difference(there.head, here.head);
  if (!found || found->empty())
    return "its hash differs";
  if (there.head.contains("study") != here.head.contains("study"))
    return fmt::format("it has {} there", there.head.contains("study") ? "variants" : "no variants");
  std::string pointer = found->to_string();
  const std::string key = pointer.substr(1, pointer.find('/', 1) - 1);
  if (key == "inputs" && there.head.contains(key) && here.head.contains(key))
    return input_difference(there.head.at(key), here.head.at(key));
  const std::string values =
      fmt::format("{} there, {} here", short_text(there.head, *found), short_text(here.head, *found));
  if (key == "study")
    return "other variants after the first";
  if (const std::string place = pointer.substr(1 + key.size()); key == "setup" && !place.empty())
    return fmt::format("the setup differs at {}: {}", escaped(place), values);
  return fmt::format("its {} differs: {}", escaped(key), values);
}

} // namespace pmdsim
