// The library stays usable after calls that fail, and loses no memory by them.

#include "tests/faults/shell.h"
#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim::test;

namespace {

void check_library(std::size_t most) {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup =
      work.write("setup.json",
                 with(small_setup(), "\"sensors\":", R"("frames": {"rate_hz": 10, "count": 3}, "sensors":)"));
  // The validation layer takes no failure well, and keeps memory.
  const std::string command = fmt::format("PMDSIM_VALIDATE=0 LD_PRELOAD='{}' '{}' '{}' {} 2>&1",
                                          PMDSIM_FAILING_CALLS, PMDSIM_LIBRARY_FAULTS, setup, most);
  const ShellRun run = run_in_shell(command);
  fmt::print("{}", run.output);
  INFO(run.output);
  CHECK(run.exit_code == 0);
}

} // namespace

TEST_CASE("The library stays usable after calls that fail", "[no_sanitizer]") { check_library(40); }
TEST_CASE("The library stays usable after calls that fail, many of them", "[long]") { check_library(2000); }
