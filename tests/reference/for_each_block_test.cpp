#include "engine/reference/for_each_block.h"

#include <array>
#include <catch2/catch.hpp>
#include <stdexcept>

using pmdsim::reference::for_each_block;

TEST_CASE("every block is worked on once, by any number of threads") {
  const unsigned threads = GENERATE(0u, 1u, 2u, 5u);
  std::array<std::atomic<int>, 100> calls{};
  double last_progress = 0.0;
  for_each_block(
      100, [&](std::size_t block) { ++calls.at(block); }, [&](double done) { last_progress = done; },
      threads);
  for (const std::atomic<int> &of_block : calls)
    CHECK(of_block == 1);
  CHECK(last_progress == 1.0);
}

TEST_CASE("what a helper throws comes out of the calling thread") {
  const auto caller = std::this_thread::get_id();
  std::atomic<bool> thrown = false;
  const auto throw_in_helper = [&](std::size_t) {
    if (std::this_thread::get_id() != caller) {
      thrown = true;
      thrown.notify_all();
      throw std::runtime_error("out of a helper");
    }
    thrown.wait(false);
  };
  CHECK_THROWS_WITH(for_each_block(1000, throw_in_helper, {}, 2), "out of a helper");
}
