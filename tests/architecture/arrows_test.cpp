// The folder layout is the architecture: which folder may include which (DESIGN: "The house").

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path root = PMDSIM_SOURCE_DIR;

// What the files of `folder` may include, as regular expressions over the include's path. The first rule
// whose folder fits a file counts, so the narrower folders come first.
struct Rule {
  std::string folder;
  std::vector<std::string> allowed;
};

const std::string plain_engine = "engine/"
                                 "(accuracy|device_info|error|illuminator|measurement|pass_time|pose|scene|"
                                 "sensor|shadows|simulator_options)"
                                 "\\.h";
const std::string lens = "engine/lens(_fault)?\\.h"; // the judge must not know them
const std::string public_engine = "engine/([a-z_]+|reference/reference)\\.h";

const std::vector<Rule> rules{
    {"engine/vulkan/", {"engine/vulkan/.*", "engine/(device_info|error|pass_time)\\.h", "vulkan/.*"}},
    // The one file of the passes that Embree helps: it builds the tree.
    {"engine/shadow/occluder_tree.cpp",
     {"engine/passes/occluder_tree\\.h", "engine/error\\.h", "embree3/rtcore\\.h"}},
    {"engine/passes/",
     {"engine/passes/.*", "engine/vulkan/.*", plain_engine, lens, "shaders/(lit_)?interface\\.h", "spirv/.*",
      "vulkan/.*"}},
    {"engine/reference/", {"engine/reference/.*", plain_engine, "embree3/.*"}},
    {"engine/simulator.cpp", {"engine/passes/.*", "engine/vulkan/.*", public_engine}},
    {"engine/", {plain_engine, lens, "engine/tap_sequence\\.h"}}, // the public headers: plain data, no Vulkan
    {"host/input/", {"host/input/.*", public_engine}},
    {"host/output/", {"host/output/.*", public_engine}},
    {"host/", {"host/.*", public_engine}}, // never Vulkan, never the engine's inside
    {"shaders/shadow/lit_interface.h", {"shaders/interface\\.h"}},
    {"shaders/", {}},
};

// Paths that belong to the project, to Vulkan or to Embree; any other library is a matter of CMake.
const std::regex ours("(engine|host|shaders|spirv|tests|vulkan|embree3)/.*");

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
  for (const Rule &rule : rules)
    if (file.starts_with(rule.folder)) {
      for (const std::string &allowed : rule.allowed)
        if (std::regex_match(include, std::regex(allowed)))
          return true;
      return false;
    }
  return true;
}

} // namespace

TEST_CASE("includes follow the allowed arrows") {
  int files = 0;
  for (const char *folder : {"engine", "host", "shaders"})
    for (const auto &entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp")
        continue;
      ++files;
      const std::string file = fs::relative(entry.path(), root);
      for (const std::string &include : includes_of(entry.path())) {
        INFO(file << " includes " << include);
        CHECK(is_allowed(file, include));
      }
    }
  CHECK(files > 50);
}

TEST_CASE("an arrow against the architecture is noticed") {
  CHECK_FALSE(is_allowed("host/main.cpp", "vulkan/vulkan_raii.hpp"));
  CHECK_FALSE(is_allowed("host/commands/render.cpp", "engine/view/points_pass.h"));
  CHECK_FALSE(is_allowed("engine/reference/light/return_sum.cpp", "shaders/shared/interface.h"));
  CHECK_FALSE(is_allowed("engine/reference/view/camera_frame.cpp", "engine/model/lens.h"));
  CHECK_FALSE(is_allowed("engine/vulkan/device.cpp", "engine/model/sensor.h"));
  CHECK_FALSE(is_allowed("engine/simulator.h", "vulkan/vulkan.h"));
  CHECK_FALSE(is_allowed("engine/shadow/tile_shadow_pass.cpp", "embree3/rtcore.h"));
  CHECK_FALSE(is_allowed("engine/simulator.cpp", "embree3/rtcore.h"));
  CHECK_FALSE(is_allowed("host/main.cpp", "embree3/rtcore.h"));
  CHECK(is_allowed("engine/simulator.cpp", "engine/view/points_pass.h"));
  CHECK(is_allowed("engine/shadow/occluder_tree.cpp", "embree3/rtcore.h"));
}
