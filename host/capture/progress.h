#pragma once
// The progress of a long command, and its interruption: on stderr a bar with the time left, or a line a
// minute where it is no terminal; and SIGINT, SIGTERM and SIGHUP, which become an Error at the next safe
// point, so that destructors clean up.

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace pmdsim {

// Installs the handlers of the signals; once, at the start. SIGHUP stays ignored where nohup has made it so.
// A write to nobody, or beyond the size that a file may have, is an error where it is made, and ends nothing
// by itself. A second signal, a second or two after the first or later, ends the process at once.
void stop_on_signals();

// Throws Error (interrupted) where a signal has come.
void throw_if_interrupted();

// When a work began, and when it was last told of.
struct ProgressClock {
  using Clock = std::chrono::steady_clock;
  Clock::time_point start = Clock::now();
  std::optional<Clock::time_point> last_shown{};
};

// Which of several like parts of a work a bar is of; they have a clock in common.
struct ProgressPart {
  std::size_t index = 0, count = 1;
  std::shared_ptr<ProgressClock> clock = std::make_shared<ProgressClock>();
};

// A bar of a command's steps, one after the other. It is shown from the first update on, and cleared when it
// dies. Where stderr is no terminal it is a line a minute, from the first minute's end on. Debian 12 has no
// library for it.
class ProgressBar {
public:
  // `work` is that of all steps together, in any unit, of the part.
  explicit ProgressBar(double work, ProgressPart part = {});
  ~ProgressBar();
  ProgressBar(const ProgressBar &) = delete;
  ProgressBar &operator=(const ProgressBar &) = delete;

  // So much is done by now, by this command or others.
  void reach(double work);
  // Begins the next step; all before it are done.
  void begin(std::string label, double work);
  // `fraction` of the step done, 0 to 1. Cheap enough to be called often.
  void update(double fraction);

private:
  std::string label_;
  double work_, done_ = 0.0, step_ = 0.0; // of all steps, of those before the current one, of the current one
  ProgressPart part_;
  bool on_terminal_;
};

// For what reports its progress: updates the bar and throws Error (interrupted) once a signal has come. `bar`
// must outlive it.
std::function<void(double)> interruptible_progress(ProgressBar &bar);

// "[##########----------] 50 %, 12 s left"; no time where nothing is done yet.
std::string progress_text(double fraction, double elapsed_s);
// For a log: "pmdsim: frame 3/20, pmd: 50 %, 12 s left\n".
std::string progress_line(const std::string &label, double fraction, double elapsed_s);

} // namespace pmdsim
