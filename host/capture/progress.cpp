#include "host/capture/progress.h"

#include "engine/model/error.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <fmt/format.h>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace pmdsim {
namespace {

std::atomic<std::int64_t> first_signal_s{0}; // when it came; 0: none has
std::atomic<bool> tells{false};              // stderr is a terminal
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free,
              "a signal handler may touch nothing else");

constexpr std::int64_t patience_s = 1; // several at once, as schedulers send them, are one

// At least 1.
std::int64_t clock_s() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec + 1;
}

// A step may take seconds to its next safe point, and there is none in reading a file. Who asks again does
// not want to wait for it.
void remember(int signal) {
  constexpr std::string_view text =
      "\r\x1b[Kpmdsim: stopping at the next safe point; once more ends it at once\r\n";
  const int error_before = errno;
  const std::int64_t now_s = clock_s();
  std::int64_t before_s = 0;
  if (first_signal_s.compare_exchange_strong(before_s, now_s)) {
    if (tells) [[maybe_unused]]
      const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
  } else if (now_s > before_s + patience_s) {
    std::signal(signal, SIG_DFL);
    ::raise(signal);
  }
  errno = error_before;
}

constexpr auto interval_of_bar = std::chrono::milliseconds(100);
constexpr auto interval_of_lines = std::chrono::minutes(1);
constexpr const char *clear_line = "\r\x1b[K";

std::string time_text(double time_s) {
  if (time_s <= 120.0)
    return fmt::format("{:.0f} s", std::ceil(time_s));
  return time_s <= 7200.0 ? fmt::format("{:.0f} min", std::ceil(time_s / 60.0))
                          : fmt::format("{:.1f} h", time_s / 3600.0);
}

// "50 %, 12 s left".
std::string share_text(double done, double elapsed_s) {
  std::string text = fmt::format("{:.0f} %", 100.0 * done);
  if (done > 0.0)
    text += ", " + time_text(elapsed_s * (1.0 - done) / done) + " left";
  return text;
}

} // namespace

void stop_on_signals() {
  tells = ::isatty(STDERR_FILENO) == 1;
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART; // writes under way go on; the flag is looked at between them
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  if (sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &action, nullptr);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);
}

void throw_if_interrupted() {
  if (first_signal_s != 0)
    throw Error(ExitCode::interrupted, "interrupted");
}

ProgressBar::ProgressBar(double work, ProgressPart part)
    : work_(work), part_(std::move(part)), on_terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (on_terminal_ && part_.clock->last_shown)
    std::fputs(clear_line, stderr);
}

void ProgressBar::reach(double work) {
  done_ = work;
  step_ = 0.0;
}

void ProgressBar::begin(std::string label, double work) {
  label_ = std::move(label);
  done_ += std::exchange(step_, work);
  update(0.0);
}

void ProgressBar::update(double fraction) {
  ProgressClock &clock = *part_.clock;
  const auto now = ProgressClock::Clock::now();
  if (on_terminal_ ? clock.last_shown && now - *clock.last_shown < interval_of_bar
                   : now - clock.last_shown.value_or(clock.start) < interval_of_lines)
    return;
  const double elapsed_s = std::chrono::duration<double>(now - clock.start).count();
  const double share = (static_cast<double>(part_.index) + (done_ + fraction * step_) / work_) /
                       static_cast<double>(part_.count);
  const std::string text = on_terminal_
                               ? fmt::format("{}{} {}", clear_line, label_, progress_text(share, elapsed_s))
                               : progress_line(label_, share, elapsed_s);
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
  clock.last_shown = now;
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
  return fmt::format("[{:#<{}}{:-<{}}] {}", "", filled, "", width - filled, share_text(done, elapsed_s));
}

std::string progress_line(const std::string &label, double fraction, double elapsed_s) {
  return fmt::format("pmdsim: {}: {}\n", label, share_text(std::clamp(fraction, 0.0, 1.0), elapsed_s));
}

} // namespace pmdsim
