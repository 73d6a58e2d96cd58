// A specialization constant has one number and one name in all modules, those of shaders/shared/constants.h.

#include "engine/vulkan/shader_module.h"

#include <catch2/catch.hpp>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <set>

using namespace pmdsim::vulkan;

namespace {

// Numbers and names of the header, in its order.
std::vector<std::pair<std::uint32_t, std::string>> read_constants() {
  static const std::regex row(R"(^PMDSIM_CONSTANT constant_(\w+) = (\d+); // .+)");
  std::vector<std::pair<std::uint32_t, std::string>> constants;
  std::ifstream header(PMDSIM_SOURCE_DIR "/shaders/shared/constants.h");
  std::smatch match;
  for (std::string line; std::getline(header, line);)
    if (std::regex_match(line, match, row))
      constants.push_back({static_cast<std::uint32_t>(std::stoul(match[2])), match[1]});
  return constants;
}

const char *form_of(const ShaderModule &module) {
  return module.real == SampleReal::any ? "" : module.real == SampleReal::fp64 ? ", fp64" : ", float pairs";
}

} // namespace

TEST_CASE("constants are numbered one by one and named once") {
  std::uint32_t count = 0;
  std::set<std::string> names;
  for (const auto &[number, name] : read_constants()) {
    CHECK(number == count++);
    CHECK(names.insert(name).second);
  }
  CHECK(count > 0);
}

TEST_CASE("every module's constants have the numbers and names of the header, and each is some module's") {
  const auto constants = read_constants();
  std::set<std::string> used;
  for (const ShaderModule &module : shader_modules()) {
    std::cout << module.name << form_of(module) << ":";
    for (const auto &[number, name] : declared_constants(module.spirv)) {
      INFO(module.name << form_of(module) << " declares " << name << " as " << number);
      REQUIRE(number < constants.size());
      CHECK(constants[number] == std::pair(number, name));
      used.insert(name);
      std::cout << ' ' << name;
    }
    std::cout << '\n';
  }
  CHECK(used.size() == constants.size());
}

TEST_CASE("a module has a name, and one form for each arithmetic or one for all") {
  std::map<std::string_view, std::vector<SampleReal>> forms;
  for (const ShaderModule &module : shader_modules())
    forms[module.name].push_back(module.real);
  for (const auto &[name, reals] : forms) {
    INFO(name);
    const bool both = reals == std::vector{SampleReal::fp64, SampleReal::float_pairs};
    CHECK((both || reals == std::vector{SampleReal::any}));
  }
}
