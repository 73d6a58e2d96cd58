#pragma once
// How the program refuses: by its exit code, one line on stderr and nothing on stdout.

#include "tests/program/program.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace pmdsim::test {

// `run` failed with `exit_code` in one line that holds every one of `fragments`.
inline void check_refusal(const Run &run, int exit_code, const std::vector<std::string> &fragments) {
  INFO(run.errors);
  CHECK(run.exit_code == exit_code);
  CHECK(std::ranges::count(run.errors, '\n') == 1);
  CHECK(run.errors.starts_with("pmdsim: error: "));
  for (const std::string &fragment : fragments) {
    INFO("expected in the message: " << fragment);
    CHECK(run.errors.find(fragment) != std::string::npos);
  }
  CHECK(run.output.empty());
}

} // namespace pmdsim::test
