#pragma once
// `pmdsim correct` of a setup in a folder of its own.

#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim::test {

struct Corrections {
  Workspace work;
  std::string setup{}; // its file

  Run correct(const std::string &image, const std::vector<std::string> &more = {}) const {
    std::vector<std::string> arguments{"correct", setup, image, "-o", work / "corrected"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_pmdsim(arguments);
  }
  nlohmann::json corrected(const std::string &image, std::vector<std::string> more = {}) const {
    more.emplace_back("--json");
    const Run run = correct(image, more);
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
    return nlohmann::json::parse(run.output);
  }
};

} // namespace pmdsim::test
