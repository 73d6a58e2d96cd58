#include "host/input/words/near_file.h"

#include "host/input/words/folder_names.h"
#include "host/input/words/near_name.h"
#include "host/input/words/quotes.h"

#include <algorithm>
#include <fmt/format.h>
#include <system_error>
#include <vector>

namespace pmdsim {
namespace {

constexpr std::size_t most_entries = 10'000; // of a folder, that are looked at

bool is_there(const std::filesystem::path &file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

std::vector<std::string> sorted_names_in(const std::filesystem::path &folder) {
  std::error_code ignored;
  std::vector<std::string> names = names_in(folder, ignored, most_entries);
  std::ranges::sort(names);
  return names;
}

// "parts\wall.gltf" as "parts/wall.gltf".
std::filesystem::path with_slashes(const std::filesystem::path &file) {
  std::string text = file.string();
  std::ranges::replace(text, '\\', '/');
  return text;
}

// The outermost folder on the way that is not there.
std::filesystem::path absent_folder(const std::filesystem::path &file) {
  std::filesystem::path absent = file.parent_path();
  while (absent.has_parent_path() && absent != absent.parent_path() && !is_there(absent.parent_path()))
    absent = absent.parent_path();
  return absent;
}

// The same name with another ending first, then what is spelt alike.
std::optional<std::string> near_in_folder(const std::filesystem::path &file) {
  const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
  const std::vector<std::string> names = sorted_names_in(folder);
  const std::string name = file.filename().string();
  const auto same = std::ranges::find_if(names, [&](const std::string &other) {
    const std::filesystem::path path(other);
    return path.stem() == file.filename().stem() && path.extension() != file.extension();
  });
  auto nearest = nearest_name(name, names);
  if (nearest && edits_between(name, *nearest) <= 1)
    return nearest;
  return same != names.end() ? std::optional(*same) : nearest;
}

} // namespace

std::string absent_file_hint(const std::filesystem::path &file) {
  const std::string text = file.string();
  if (text.find("://") != std::string::npos || text.find("http:/") != std::string::npos ||
      text.find("https:/") != std::string::npos)
    return ", expected a file of this machine, not an address";
  if (text.starts_with("~"))
    return ", expected a path without ~";
  if (const auto slashed = with_slashes(file); slashed != file && is_there(slashed))
    return ", expected / between folders, not a backslash";
  const std::filesystem::path folder = file.parent_path();
  if (!folder.empty() && !is_there(folder)) {
    const std::filesystem::path absent = absent_folder(file);
    const auto near = near_in_folder(absent);
    return near ? fmt::format(", did you mean the folder {}?",
                              in_quotes((absent.parent_path() / *near).string()))
                : fmt::format(", there is no folder {}", in_quotes(absent.string()));
  }
  const auto near = near_in_folder(file);
  return near ? fmt::format(", did you mean {}?", in_quotes(*near)) : "";
}

} // namespace pmdsim
