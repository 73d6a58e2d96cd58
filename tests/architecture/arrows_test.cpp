// The folder layout is the architecture: which room may include which stands in a table of ARCHITECTURE.md,
// and no room grows beyond what one can look over.

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path root = PMDSIM_SOURCE_DIR;
constexpr std::size_t largest_room = 25;

// Each room with what it may include beside itself: rooms, and folders of Vulkan and Embree.
using Arrows = std::map<std::string, std::vector<std::string>>;

std::vector<std::string> names_in(const std::string &cell) {
  static const std::regex name("`([^`]+)`");
  std::vector<std::string> names;
  for (std::sregex_iterator i(cell.begin(), cell.end(), name), end; i != end; ++i)
    names.push_back((*i)[1]);
  return names;
}

// The rows "| `room` | `room`, `room` |" below the heading "Arrows".
Arrows read_arrows() {
  static const std::regex row(R"(^\| *(`[^|]*`) *\| *([^|]*)\|.*$)");
  Arrows arrows;
  std::ifstream document(root / "ARCHITECTURE.md");
  bool inside = false;
  std::smatch match;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("## "))
      inside = line == "## Arrows";
    if (inside && std::regex_match(line, match, row))
      for (const std::string &room : names_in(match[1]))
        arrows[room] = names_in(match[2]);
  }
  return arrows;
}

const Arrows &arrows() {
  static const Arrows read = read_arrows();
  return read;
}

// The longest of the table's names that is a folder around the path or the path itself.
template <typename Names>
std::string room_of(const std::string &path, const Names &names) {
  std::string found;
  for (const auto &name : names)
    if ((path == name || path.starts_with(name + "/")) && name.size() > found.size())
      found = name;
  return found;
}

std::vector<std::string> rooms() {
  std::vector<std::string> names;
  for (const auto &[name, may_include] : arrows())
    names.push_back(name);
  return names;
}

// Paths that belong to the project, to Vulkan or to Embree; any other library is a matter of CMake.
const std::regex ours("(engine|host|shaders|tests|vulkan|embree3)/.*");

std::vector<std::string> includes_of(const fs::path &file) {
  static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<std::string> found;
  std::ifstream in(file);
  std::smatch match;
  for (std::string line; std::getline(in, line);)
    if (std::regex_search(line, match, include) && std::regex_match(match[1].str(), ours))
      found.push_back(match[1]);
  return found;
}

bool is_allowed(const std::string &file, const std::string &include) {
  const std::string room = room_of(file, rooms());
  if (room.empty())
    return false;
  const std::string included = room_of(include, rooms());
  if (included == room)
    return true;
  const std::vector<std::string> &may = arrows().at(room);
  return !room_of(include, may).empty() &&
         (included.empty() || std::ranges::find(may, included) != may.end() ||
          std::ranges::find(may, include) != may.end());
}

bool is_source(const fs::path &file) {
  static const std::vector<std::string> extensions{".h", ".cpp", ".glsl", ".comp", ".vert", ".frag"};
  return std::ranges::find(extensions, file.extension().string()) != extensions.end();
}

} // namespace

TEST_CASE("includes follow the allowed arrows") {
  int files = 0;
  for (const char *folder : {"engine", "host", "shaders"})
    for (const auto &entry : fs::recursive_directory_iterator(root / folder)) {
      if (!is_source(entry.path()))
        continue;
      ++files;
      const std::string file = fs::relative(entry.path(), root);
      for (const std::string &include : includes_of(entry.path())) {
        INFO(file << " includes " << include);
        CHECK(is_allowed(file, include));
      }
    }
  CHECK(files > 300);
}

TEST_CASE("the arrows run in one direction") {
  for (const auto &[room, may_include] : arrows())
    for (const std::string &other : may_include) {
      INFO(room << " and " << other << " may include each other");
      const auto back = arrows().find(other);
      const bool both = back != arrows().end() && std::ranges::find(back->second, room) != back->second.end();
      CHECK_FALSE(both);
    }
}

TEST_CASE("no room has more files than one can look over") {
  std::map<std::string, std::size_t> files;
  for (const char *folder : {"engine", "host", "shaders", "scenes", "tests"})
    for (const auto &entry : fs::recursive_directory_iterator(root / folder))
      if (const std::string room = fs::relative(entry.path().parent_path(), root);
          entry.is_regular_file() &&
          !room.starts_with("tests/fuzz/corpus/")) // fuzzers' inputs are read by nobody
        ++files[room];
  for (const auto &[folder, count] : files) {
    INFO(folder << " has " << count << " files");
    CHECK(count <= largest_room);
  }
}

TEST_CASE("an arrow against the architecture is noticed") {
  CHECK_FALSE(is_allowed("host/main.cpp", "vulkan/vulkan_raii.hpp"));
  CHECK_FALSE(is_allowed("host/main.cpp", "embree3/rtcore.h"));
  CHECK_FALSE(is_allowed("host/commands/render.cpp", "engine/view/points_pass.h"));
  CHECK_FALSE(is_allowed("host/input/setup/loader.cpp", "host/commands/commands.h"));
  CHECK_FALSE(is_allowed("engine/reference/light/return_sum.cpp", "shaders/shared/interface.h"));
  CHECK_FALSE(is_allowed("engine/reference/view/camera_frame.cpp", "engine/lens/lens.h"));
  CHECK_FALSE(is_allowed("engine/vulkan/device.cpp", "engine/model/sensor.h"));
  CHECK_FALSE(is_allowed("engine/simulator.h", "vulkan/vulkan.h"));
  CHECK_FALSE(is_allowed("engine/simulator.cpp", "embree3/rtcore.h"));
  CHECK_FALSE(is_allowed("engine/reduction/cluster.cpp", "engine/vulkan/buffer.h"));
  CHECK_FALSE(is_allowed("engine/view/points_pass.cpp", "engine/light/tones.h"));
  CHECK_FALSE(is_allowed("engine/light/accumulate_pass.h", "engine/error_budget/plan.h"));
  CHECK_FALSE(is_allowed("shaders/sampling/chip.glsl", "shaders/light/sum.glsl"));
  CHECK(is_allowed("engine/frame/frame_passes.cpp", "engine/view/points_pass.h"));
}
