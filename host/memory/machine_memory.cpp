#include "host/memory/machine_memory.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>
#include <unistd.h>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

// The number that a file holds; nothing for "max" and where there is none.
std::optional<std::uint64_t> number_in_file(const fs::path &file) {
  std::ifstream in(file);
  std::string word;
  std::uint64_t number = 0;
  if (!(in >> word))
    return std::nullopt;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(number) : std::nullopt;
}

// The number behind a name, in a file with a name and a number a line.
std::optional<std::uint64_t> number_named(const fs::path &file, std::string_view name) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first;
    std::uint64_t number = 0;
    if (words >> first >> number && first == name)
      return number;
  }
  return std::nullopt;
}

// The names of a version's files.
struct GroupFiles {
  const char *limit, *used, *unused_pages;
};
constexpr GroupFiles files_v2{"memory.max", "memory.current", "inactive_file"};
constexpr GroupFiles files_v1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};

// What the group at a folder leaves.
std::uint64_t left_by_group(const fs::path &folder, const GroupFiles &files) {
  const auto limit = number_in_file(folder / files.limit), used = number_in_file(folder / files.used);
  if (!limit || !used)
    return unlimited;
  const std::uint64_t unused =
      std::min(number_named(folder / "memory.stat", files.unused_pages).value_or(0), *used);
  return *limit - std::min(*limit, *used - unused);
}

// What a group and all above it leave; `mount` is where the tree of groups is.
std::uint64_t left_by_groups(const fs::path &mount, const fs::path &group, const GroupFiles &files) {
  std::uint64_t left = left_by_group(mount, files);
  fs::path folder = mount;
  for (const fs::path &part : group.relative_path()) {
    folder /= part;
    left = std::min(left, left_by_group(folder, files));
  }
  return left;
}

bool is_of_memory(std::string_view controllers) {
  for (std::string_view rest = controllers; !rest.empty();) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    if (rest.substr(0, end) == "memory")
      return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

// Lines "0::/a/b" of version 2, "4:memory:/a/b" of version 1.
std::uint64_t left_by_control_groups(const fs::path &root) {
  const fs::path mount = root / "sys/fs/cgroup";
  std::ifstream in(root / "proc/self/cgroup");
  std::uint64_t left = unlimited;
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == line.npos ? line.npos : line.find(':', first + 1);
    if (second == line.npos)
      continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path group = line.substr(second + 1);
    if (controllers.empty())
      left = std::min(left, left_by_groups(mount, group, files_v2));
    else if (is_of_memory(controllers))
      left = std::min(left, left_by_groups(mount / "memory", group, files_v1));
  }
  return left;
}

} // namespace

AvailableMemory available_memory(const fs::path &root) {
  constexpr std::uint64_t kilobyte = 1024; // of /proc/meminfo
  const auto of_machine = number_named(root / "proc/meminfo", "MemAvailable:");
  const std::uint64_t machine = of_machine ? *of_machine * kilobyte : unlimited;
  const std::uint64_t group = left_by_control_groups(root);
  return group < machine ? AvailableMemory{group, "the control group"}
                         : AvailableMemory{machine, "the machine"};
}

std::uint64_t taken_memory() {
  std::ifstream in("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  in >> all >> resident;
  return resident * static_cast<std::uint64_t>(std::max(::sysconf(_SC_PAGESIZE), 1L));
}

} // namespace pmdsim
