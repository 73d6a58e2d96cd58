#pragma once
// A bar on stderr with the time left, only where stderr is a terminal. Debian 12 has no library for it.

#include <chrono>
#include <functional>
#include <string>

namespace pmdsim {

// Shown from the first update on; cleared when it dies.
class ProgressBar {
public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();
  ProgressBar(const ProgressBar &) = delete;
  ProgressBar &operator=(const ProgressBar &) = delete;

  // `fraction` done, 0 to 1. Cheap enough to be called often.
  void update(double fraction);

private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  bool on_terminal_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_;
};

// For what reports its progress: updates the bar and throws Error (interrupted) once a signal has come. `bar`
// must outlive it.
std::function<void(double)> interruptible_progress(ProgressBar &bar);

// "[##########----------]  50 %, 12 s left"; no time where nothing is done yet.
std::string progress_text(double fraction, double elapsed_s);

} // namespace pmdsim
