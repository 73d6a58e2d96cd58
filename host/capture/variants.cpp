#include "host/capture/variants.h"

#include "engine/model/error.h"
#include "host/input/file/input_error.h"
#include "host/input/file/input_file.h"
#include "host/input/file/json_file.h"
#include "host/input/file/memory_request.h"
#include "host/input/words/utf8.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace pmdsim {

using nlohmann::json;

namespace {

constexpr std::size_t most_variants = 100'000;
constexpr std::size_t most_paths = 1024; // each a column of the table

bool has_one_named(const json &setup, const char *list, const std::string &name) {
  return setup.is_object() && setup.contains(list) && setup.at(list).is_array() &&
         std::ranges::any_of(setup.at(list), [&](const json &each) {
           return each.is_object() && each.contains("name") && each.at("name") == name;
         });
}

void refuse_doubled_names(const std::vector<SetupDocument> &setups) {
  std::set<std::filesystem::path> names;
  for (const SetupDocument &setup : setups)
    if (!names.insert(frames_folder_of(setup.file)).second)
      throw Error(ExitCode::usage,
                  fmt::format("{}: expected setups of different names, as they name the folders of "
                              "their frames",
                              in_one_line(setup.file.string())));
}

// Each variant has its setup's document, as its changes leave it.
void require_memory_for(std::size_t variants, const std::vector<SetupDocument> &setups,
                        const std::filesystem::path &file) {
  constexpr std::size_t tree_bytes = 10; // about, for each byte of text
  std::size_t bytes = 0;
  for (const SetupDocument &setup : setups)
    bytes += tree_bytes * setup.json.dump().size();
  require_memory(variants * bytes, Place{file}, fmt::format("{} variants of each setup", variants));
}

// Its errors have the number of the line.
json json_of_line(std::string_view line, std::size_t lines_before, const std::filesystem::path &file) {
  try {
    return parse_json(line, file, Comments::refused);
  } catch (const Error &) {
    return parse_json(std::string(lines_before, '\n') + std::string(line), file, Comments::refused);
  }
}

} // namespace

std::string frames_folder_of(const std::filesystem::path &setup) {
  std::string name = setup.stem().string();
  if (setup.has_extension() && (name == "." || name == ".."))
    throw Error(ExitCode::usage,
                fmt::format("{}: expected a setup with a name before its ending, as it names "
                            "the folder of its frames",
                            in_one_line(setup.string())));
  return name;
}

json changes_for(const PosesFromFile &poses, const SetupDocument &document) {
  read_front_of_regular_file(poses.file, 0, Place{poses.file}); // an error has the name as it was given
  const json trajectory{
      {"trajectory",
       std::filesystem::proximate(poses.file, document.folder.empty() ? "." : document.folder).string()}};
  const char *list = "nodes";
  for (const char *other : {"illuminators", "sensors"})
    if (has_one_named(document.json, other, poses.name))
      list = other;
  const std::string of = poses.name.empty() ? "sensors/0" : list + ("/" + escaped(poses.name));
  return {{of + "/pose", trajectory}, {"frames", trajectory}};
}

std::vector<VariantLine> read_variants(const std::filesystem::path &file) {
  const std::string text = read_text_file(file, Place{file});
  std::vector<VariantLine> variants;
  std::set<std::string> paths;
  std::size_t before = 0; // lines
  for (std::string_view rest = text; !rest.empty(); ++before) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos)
      continue;
    const TextPlace place{file, before + 1};
    if (variants.size() == most_variants)
      throw input_error(place, fmt::format("expected at most {} variants", most_variants));
    variants.push_back({place.line, json_of_line(line, before, file)});
    if (!variants.back().changes.is_object())
      throw input_error(place, "expected an object of paths and values");
    for (const auto &[path, value] : variants.back().changes.items())
      paths.insert(path);
    if (paths.size() > most_paths)
      throw input_error(place, fmt::format("expected at most {} paths in all variants", most_paths));
  }
  if (variants.empty())
    throw input_error(Place{file}, "expected at least one variant, an object of paths and values a line");
  return variants;
}

std::vector<Variant> variants_of(const std::vector<SetupDocument> &setups,
                                 const std::optional<std::filesystem::path> &variants) {
  refuse_doubled_names(setups);
  const std::vector<VariantLine> lines =
      variants ? read_variants(*variants) : std::vector<VariantLine>{{0, json::object()}};
  if (variants)
    require_memory_for(lines.size(), setups, *variants);
  std::vector<Variant> all;
  for (const SetupDocument &setup : setups)
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string number = variants ? fmt::format("{:04}", i) : "";
      const std::string stem = setups.size() > 1 ? frames_folder_of(setup.file) : "";
      const std::string name = variants ? (std::filesystem::path(stem) / number).string() : stem;
      Variant variant{name, setup, lines[i].changes};
      try {
        if (variants)
          change(variant.document, lines[i].changes, fmt::format("{}:{}", variants->string(), lines[i].line));
      } catch (const Error &error) {
        throw Error(error.code(),
                    variants ? fmt::format("{}, in variant {}", error.what(), name) : error.what(),
                    error.where());
      }
      all.push_back(std::move(variant));
    }
  return all;
}

} // namespace pmdsim
