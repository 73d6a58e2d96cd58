#include "host/threads.h"

#include <latch>
#include <mutex>
#include <optional>
#include <system_error>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <thread>
#include <vector>

namespace pmdsim {
namespace {

// How many threads run at once beside this one where so many are asked for.
int threads_that_start(int wanted) {
  std::latch all_tried(1);
  std::vector<std::jthread> threads;
  threads.reserve(static_cast<std::size_t>(wanted));
  const auto release = [&] { all_tried.count_down(); };
  try {
    while (static_cast<int>(threads.size()) < wanted)
      threads.emplace_back([&] { all_tried.wait(); });
  } catch (const std::system_error &) {
    wanted = static_cast<int>(threads.size());
  } catch (...) {
    release();
    throw;
  }
  release();
  return wanted;
}

} // namespace

void settle_threads() {
  static std::mutex mutex;
  static std::optional<tbb::global_control> limit;
  static int most = tbb::info::default_concurrency(); // beside the calling thread, as run_pipeline() has them
  const std::scoped_lock lock(mutex);
  const int there = threads_that_start(most);
  if (there == most)
    return;
  most = there;
  limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(there) + 1);
}

} // namespace pmdsim
