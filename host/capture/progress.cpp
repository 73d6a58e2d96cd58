#include "host/capture/progress.h"

#include "engine/model/error.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <fmt/format.h>
#include <unistd.h>
#include <utility>

namespace pmdsim {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch nothing else");

void remember(int) { interrupted = true; }

constexpr auto least_interval = std::chrono::milliseconds(100);
constexpr const char *clear_line = "\r\x1b[K";

std::string time_text(double time_s) {
  if (time_s <= 120.0)
    return fmt::format("{:.0f} s", std::ceil(time_s));
  return time_s <= 7200.0 ? fmt::format("{:.0f} min", std::ceil(time_s / 60.0))
                          : fmt::format("{:.1f} h", time_s / 3600.0);
}

} // namespace

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART; // writes under way go on; the flag is looked at between them
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void throw_if_interrupted() {
  if (interrupted)
    throw Error(ExitCode::interrupted, "interrupted");
}

ProgressBar::ProgressBar(double work) : work_(work), on_terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (shown_)
    std::fputs(clear_line, stderr);
}

void ProgressBar::begin(std::string label, double work) {
  label_ = std::move(label);
  done_ += std::exchange(step_, work);
  update(0.0);
}

void ProgressBar::update(double fraction) {
  const auto now = Clock::now();
  if (!on_terminal_ || (shown_ && now - last_shown_ < least_interval))
    return;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  std::fputs(
      fmt::format("{}{} {}", clear_line, label_, progress_text((done_ + fraction * step_) / work_, elapsed_s))
          .c_str(),
      stderr);
  std::fflush(stderr);
  last_shown_ = now;
  shown_ = true;
}

std::function<void(double)> interruptible_progress(ProgressBar &bar) {
  return [&bar](double fraction) {
    throw_if_interrupted();
    bar.update(fraction);
  };
}

std::string progress_text(double fraction, double elapsed_s) {
  constexpr std::size_t width = 20; // so that a line of a terminal holds label, bar and time
  const double done = std::clamp(fraction, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(done * width);
  std::string text = fmt::format("[{:#<{}}{:-<{}}] {:.0f} %", "", filled, "", width - filled, 100.0 * done);
  if (done > 0.0)
    text += ", " + time_text(elapsed_s * (1.0 - done) / done) + " left";
  return text;
}

} // namespace pmdsim
