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

// Of the header, in its order.
std::vector<DeclaredConstant> read_constants() {
  static const std::regex row(R"(^PMDSIM_CONSTANT constant_(\w+) = (\d+); // .+)");
  std::vector<DeclaredConstant> constants;
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
  std::uint32_t number = 0;
  std::set<std::string> names;
  for (const DeclaredConstant &constant : read_constants()) {
    CHECK(constant.number == number++);
    CHECK(names.insert(constant.name).second);
  }
  CHECK(number > 0);
}

TEST_CASE("every module's constants have the numbers and names of the header, and each is some module's") {
  const std::vector<DeclaredConstant> constants = read_constants();
  std::set<std::string> used;
  for (const ShaderModule &module : shader_modules()) {
    std::cout << module.name << form_of(module) << ":";
    for (const DeclaredConstant &constant : declared_constants(module.spirv)) {
      INFO(module.name << form_of(module) << " declares " << constant.name << " as " << constant.number);
      REQUIRE(constant.number < constants.size());
      CHECK(constant == constants[constant.number]);
      used.insert(constant.name);
      std::cout << ' ' << constant.name;
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
