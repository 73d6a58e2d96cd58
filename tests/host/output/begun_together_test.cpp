// Several processes that begin a run in one folder at the same moment: one makes the run, the others join
// it.

#include "host/output/run/run_folder.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <barrier>
#include <catch2/catch.hpp>
#include <string>
#include <thread>
#include <vector>

using namespace pmdsim;

TEST_CASE("runs that begin at the same moment in one folder all begin") {
  // Locks of run.json belong to whoever has opened it, so that threads stand for processes.
  constexpr int processes = 4, times = 100;
  const RunIdentity run{{{"program", "pmdsim"}}, "hash"};
  std::vector<std::string> failures(processes);
  for (int time = 0; time < times; ++time) {
    const test::TemporaryFolder folder;
    std::barrier start(processes);
    std::vector<std::jthread> threads;
    for (int i = 0; i < processes; ++i)
      threads.emplace_back([&, i] {
        start.arrive_and_wait();
        try {
          const RunFolder joined(folder.path(), run, {0, 1}, RunFolder::Earlier::kept, [] {});
        } catch (const std::exception &error) {
          failures[static_cast<std::size_t>(i)] = error.what();
        }
      });
  }
  CHECK(failures == std::vector<std::string>(processes));
}
