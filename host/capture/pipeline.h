#pragma once
// Things that are made one after the other, and finished while the next ones are made.

#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <type_traits>
#include <utility>

namespace pmdsim {

// The index of the first of the things that something went wrong with; those after it are of no use.
using FirstFailure = std::atomic<std::size_t>;

// Where one goes through the pipeline.
template <class Made, class Worked>
struct PipelineItem {
  std::size_t index;
  std::optional<Made> made;     // until it is worked on
  std::optional<Worked> worked; // until it is finished
  std::exception_ptr failure;

  // The exceptions of several threads are put in order, which TBB would not do.
  template <class Step>
  void attempt(FirstFailure &first, const Step &step) {
    if (failure || first < index)
      return;
    try {
      step();
    } catch (...) {
      failure = std::current_exception();
      std::size_t known = first;
      while (index < known && !first.compare_exchange_weak(known, index)) {
      }
    }
  }
};

// For each i from 0 on, as long as `has(i)`: `make(i)`, one at a time and in order; `work(i, what it made)`,
// several at once; `finish(i, what came of it)`, one at a time and in order again. All on TBB's threads and
// the calling one, each call on any of them. Beside the thing that is made at most `waiting` others are
// alive; with none, one is finished before the next is made. `has` is called once for each i, before it is
// made.
//
// Where a call throws, all things before that one are finished, and neither it nor any after it; the
// exception comes out when nothing runs any more.
template <class Has, class Make, class Work, class Finish>
void run_pipeline(const Has &has, std::size_t waiting, const Make &make, const Work &work,
                  const Finish &finish) {
  using Made = std::invoke_result_t<Make, std::size_t>;
  using Worked = std::invoke_result_t<Work, std::size_t, Made>;
  using Item = PipelineItem<Made, Worked>;
  using Handle = std::shared_ptr<Item>;
  FirstFailure first_failure(std::numeric_limits<std::size_t>::max());
  std::exception_ptr failure;
  std::size_t next = 0;

  const auto make_next = [&](tbb::flow_control &control) -> Handle {
    Handle item = std::make_shared<Item>(Item{next, {}, {}, {}});
    // Isolated: what waits in there for TBB's threads of its own takes up nothing of the pipeline's.
    tbb::this_task_arena::isolate([&] {
      item->attempt(first_failure, [&] {
        if (has(item->index))
          item->made.emplace(make(item->index));
      });
    });
    if (!item->made && !item->failure) {
      control.stop();
      return {};
    }
    ++next;
    return item;
  };
  const auto work_on = [&](const Handle &item) -> Handle {
    item->attempt(first_failure, [&] { item->worked.emplace(work(item->index, std::move(*item->made))); });
    item->made.reset();
    return item;
  };
  const auto finish_one = [&](const Handle &item) {
    item->attempt(first_failure, [&] { finish(item->index, std::move(*item->worked)); });
    if (item->failure && !failure)
      failure = item->failure;
  };

  // One thread more than the processor's, as the one that makes mostly waits for a device.
  const int threads = tbb::info::default_concurrency() + 1;
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    using tbb::filter_mode;
    tbb::parallel_pipeline(waiting + 1,
                           tbb::make_filter<void, Handle>(filter_mode::serial_in_order, make_next) &
                               tbb::make_filter<Handle, Handle>(filter_mode::parallel, work_on) &
                               tbb::make_filter<Handle, void>(filter_mode::serial_in_order, finish_one));
  });
  if (failure)
    std::rethrow_exception(failure);
}

} // namespace pmdsim
