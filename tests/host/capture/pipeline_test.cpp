// The order of a pipeline's steps, what runs beside what, and what is left where a step fails.

#include "host/capture/pipeline.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace pmdsim;

namespace {

using namespace std::chrono_literals;

// Whether `flag` is set before a pipeline that does not run things side by side would be given up.
bool comes(const std::atomic<bool> &flag) {
  const auto give_up = std::chrono::steady_clock::now() + 10s;
  while (!flag && std::chrono::steady_clock::now() < give_up)
    std::this_thread::sleep_for(1ms);
  return flag;
}

// Counts how many of it there are.
class Counted {
public:
  explicit Counted(std::atomic<int> &alive) : alive_(&alive) { ++*alive_; }
  Counted(Counted &&other) noexcept : alive_(std::exchange(other.alive_, nullptr)) {}
  Counted(const Counted &) = delete;
  Counted &operator=(const Counted &) = delete;
  Counted &operator=(Counted &&) = delete;
  ~Counted() {
    if (alive_)
      --*alive_;
  }

private:
  std::atomic<int> *alive_;
};

// Whether there is an i-th of `count` things.
auto below(std::size_t count) {
  return [count](std::size_t i) { return i < count; };
}

std::vector<std::size_t> up_to(std::size_t count) {
  std::vector<std::size_t> all(count);
  for (std::size_t i = 0; i < count; ++i)
    all[i] = i;
  return all;
}

enum class Step { make, work, finish };

// Ten things of which `failing` fail in a step; the first of them last, so that its exception comes late.
struct Failing {
  std::vector<std::size_t> finished;
  std::string message;

  Failing(Step step, const std::vector<std::size_t> &failing, std::size_t waiting) {
    const auto fail_at = [&](Step here, std::size_t i) {
      if (here != step || std::ranges::count(failing, i) == 0)
        return;
      if (step == Step::work && i == failing.front())
        std::this_thread::sleep_for(20ms);
      throw std::runtime_error(std::to_string(i));
    };
    try {
      run_pipeline(
          below(10), waiting,
          [&](std::size_t i) {
            fail_at(Step::make, i);
            return i;
          },
          [&](std::size_t i, std::size_t made) {
            fail_at(Step::work, i);
            return made;
          },
          [&](std::size_t i, std::size_t) {
            fail_at(Step::finish, i);
            finished.push_back(i);
          });
    } catch (const std::runtime_error &error) {
      message = error.what();
    }
  }
};

} // namespace

TEST_CASE("things are made and finished in order, however long the work on each takes") {
  const auto waiting = GENERATE(as<std::size_t>{}, 0, 1, 2, 7);
  std::vector<std::size_t> made, finished;
  run_pipeline(
      below(40), waiting,
      [&](std::size_t i) {
        made.push_back(i);
        return 10 * i;
      },
      [](std::size_t i, std::size_t ten_times) {
        std::this_thread::sleep_for(i % 3 == 0 ? 3ms : 0ms);
        return ten_times + 1;
      },
      [&](std::size_t i, std::size_t worked) {
        CHECK(worked == 10 * i + 1);
        finished.push_back(i);
      });
  CHECK(made == up_to(40));
  CHECK(finished == up_to(40));
}

TEST_CASE("the next thing is made while one is worked on") {
  std::atomic<bool> next_is_made = false, seen = false;
  run_pipeline(
      below(2), 1,
      [&](std::size_t i) {
        if (i == 1)
          next_is_made = true;
        return i;
      },
      [&](std::size_t i, std::size_t) {
        if (i == 0)
          seen = comes(next_is_made);
        return 0;
      },
      [](std::size_t, int) {});
  CHECK(seen);
}

TEST_CASE("two things are worked on at once") {
  std::array<std::atomic<bool>, 2> begun{}, seen{};
  run_pipeline(
      below(2), 2, [](std::size_t i) { return i; },
      [&](std::size_t i, std::size_t) {
        begun[i] = true;
        seen[i] = comes(begun[1 - i]);
        return 0;
      },
      [](std::size_t, int) {});
  CHECK(seen[0]);
  CHECK(seen[1]);
}

TEST_CASE("no more things are alive than may wait, and the one that is made") {
  const int waiting = GENERATE(0, 1, 3);
  std::atomic<int> alive = 0;
  std::atomic<int> most = 0;
  run_pipeline(
      below(50), static_cast<std::size_t>(waiting),
      [&](std::size_t) {
        Counted made(alive);
        most = std::max<int>(most, alive);
        return made;
      },
      [](std::size_t i, Counted made) {
        std::this_thread::sleep_for(i % 5 == 0 ? 5ms : 1ms);
        return made;
      },
      [](std::size_t, const Counted &) {});
  CHECK(most <= waiting + 1);
  CHECK(alive == 0);
}

TEST_CASE("what is made goes as soon as it is worked on") {
  std::atomic<int> alive = 0;
  run_pipeline(
      below(5), 0, [&](std::size_t) { return Counted(alive); },
      [](std::size_t, const Counted &) { return 0; }, [&](std::size_t, int) { CHECK(alive == 0); });
}

TEST_CASE("where a step fails, what came before is finished and nothing after") {
  const Step step = GENERATE(Step::make, Step::work, Step::finish);
  const auto waiting = GENERATE(as<std::size_t>{}, 0, 1, 4);
  const Failing failing(step, {4, 5, 6}, waiting);
  CHECK(failing.message == "4");
  CHECK(failing.finished == up_to(4));
  CHECK(Failing(step, {0}, waiting).finished.empty());
  CHECK(Failing(step, {9}, waiting).finished == up_to(9));
}

TEST_CASE("after a failure nothing more is made than what was on its way") {
  std::atomic<std::size_t> made = 0;
  const auto run = [&] {
    run_pipeline(
        below(1000), 2,
        [&](std::size_t i) {
          ++made;
          return i;
        },
        [](std::size_t i, std::size_t) -> int { throw std::runtime_error(std::to_string(i)); },
        [](std::size_t, int) {});
  };
  CHECK_THROWS_WITH(run(), "0");
  CHECK(made < 20);
}

TEST_CASE("whether there is another thing is asked once each, before it is made, and may fail") {
  std::vector<std::string> asked_and_made;
  std::vector<std::size_t> finished;
  const auto run = [&](std::size_t failing) {
    run_pipeline(
        [&](std::size_t i) {
          asked_and_made.push_back("has " + std::to_string(i));
          if (i == failing)
            throw std::runtime_error("no answer");
          return i < 2;
        },
        1,
        [&](std::size_t i) {
          asked_and_made.push_back("make " + std::to_string(i));
          return i;
        },
        [](std::size_t, std::size_t made) { return made; },
        [&](std::size_t i, std::size_t) { finished.push_back(i); });
  };
  run(3);
  CHECK(asked_and_made == std::vector<std::string>{"has 0", "make 0", "has 1", "make 1", "has 2"});
  CHECK(finished == up_to(2));
  finished.clear();
  CHECK_THROWS_WITH(run(1), "no answer");
  CHECK(finished == up_to(1));
}

TEST_CASE("a pipeline of nothing does nothing") {
  run_pipeline(
      below(0), 3, [](std::size_t i) { return i; }, [](std::size_t, std::size_t made) { return made; },
      [](std::size_t, std::size_t) { FAIL("there is nothing to finish"); });
}
