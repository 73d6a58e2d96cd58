#pragma once
// The reference's threads: blocks of pixels are handed out one at a time, as some cost far more than others.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <stop_token>
#include <system_error>
#include <thread>
#include <vector>

namespace pmdsim::reference {

// Calls work(block) once for every block, from `threads` threads, the calling one among them, or from fewer
// where the system starts no more; `progress` with the fraction done from the calling thread between its own
// blocks. Where either throws, in whichever thread, the others stop after the block that they are at, and the
// exception comes out here.
template <class Work>
void for_each_block(std::size_t blocks, const Work &work, const std::function<void(double)> &progress,
                    unsigned threads = std::thread::hardware_concurrency()) {
  std::atomic<std::size_t> next_block = 0;
  const auto help = [&](const std::stop_token &stop, std::exception_ptr &failure) {
    try {
      for (std::size_t block = next_block++; block < blocks && !stop.stop_requested(); block = next_block++)
        work(block);
    } catch (...) {
      failure = std::current_exception();
      next_block = blocks;
    }
  };
  std::vector<std::exception_ptr> failures(std::max(threads, 1U) - 1);
  std::vector<std::jthread> helpers;
  helpers.reserve(failures.size());
  try {
    for (std::exception_ptr &failure : failures)
      helpers.emplace_back(help, std::ref(failure));
  } catch (const std::system_error &) {
    failures.resize(helpers.size()); // those that there are do the work
  }

  for (std::size_t block = next_block++; block < blocks; block = next_block++) {
    work(block);
    if (progress)
      progress(static_cast<double>(block) / static_cast<double>(blocks));
  }
  // Not by their destructors, which would ask a helper to stop that has just taken the last block.
  for (std::jthread &helper : helpers)
    helper.join();
  for (const std::exception_ptr &failure : failures)
    if (failure)
      std::rethrow_exception(failure);
  if (progress)
    progress(1.0);
}

} // namespace pmdsim::reference
