#include "engine/frame/frame_graph.h"

#include "engine/sampling/pixel_lists.h"
#include "engine/vulkan/commands.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <stdexcept>

namespace pmdsim {
namespace {

// One submission's work at most: a frame can be stopped, shows its progress and holds no GPU for more than
// 100 ms (at 5e9 interactions a second, a tenth of what a small one does).
constexpr std::uint64_t interactions_per_submission = 500'000'000;

// The first, a later one and the last, which may be shorter.
std::set<std::size_t> windows_to_warm(std::size_t count) {
  return {0, std::min<std::size_t>(1, count - 1), count - 1};
}

} // namespace

void FrameGraph::check(const Pass &pass) {
  if ((pass.reads & ~written_) != 0)
    throw std::logic_error("pass " + pass.name + " reads what no pass has written");
  written_ |= pass.writes;
}

void FrameGraph::add_before(Pass pass) {
  if (!of_window_.empty() || !after_.empty())
    throw std::logic_error("pass " + pass.name + " is added too late");
  check(pass);
  before_.push_back(std::move(pass));
}

void FrameGraph::add_to_window(Pass pass) {
  if (!after_.empty())
    throw std::logic_error("pass " + pass.name + " is added too late");
  check(pass);
  of_window_.push_back(std::move(pass));
}

void FrameGraph::add_after(Pass pass) {
  check(pass);
  after_.push_back(std::move(pass));
}

void FrameGraph::run_parts(const Pass &pass, std::size_t window, Parts parts, Run &run) const {
  const shader::Strip &strip = run.planned.strip;
  const auto per_submission = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
      interactions_per_submission / pass.interactions(strip), 1, std::max(1u, pass.all_parts)));
  for (std::uint32_t first = parts.first; first < parts.last; first += per_submission) {
    const std::uint32_t last = std::min(parts.last, first + per_submission);
    pass.record({run.recorder.commands(), run.planned, run.strip, window, {first, last}});
    run.recorder.end_pass(pass.name);
    if (last == pass.all_parts)
      continue;
    run.recorder.finish();
    if (run.progress && *run.progress)
      (*run.progress)(static_cast<double>(last) / pass.all_parts);
    run.recorder.begin();
  }
}

void FrameGraph::record_pass(const Pass &pass, std::size_t window, Run &run) const {
  if (!run.open)
    run.recorder.begin();
  run.open = true;
  const Resources used = pass.reads | pass.writes;
  if ((used & run.written) != 0 || (pass.writes & run.read) != 0) {
    vulkan::compute_barrier(run.recorder.commands());
    run.written = run.read = no_resource;
  }
  run.written |= pass.writes;
  run.read |= pass.reads;
  if (pass.parts) {
    Parts parts = pass.parts(window);
    if (!run.to) // two of a kind do for a warm-up
      parts.last = std::min(parts.last, parts.first + 2);
    run_parts(pass, window, parts, run);
  } else {
    pass.record({run.recorder.commands(), run.planned, run.strip, window, {}});
    run.recorder.end_pass(pass.name);
  }
}

void FrameGraph::run_pass(const Pass &pass, std::size_t window, Run &run) const {
  if (pass.record)
    record_pass(pass, window, run);
  if (!pass.store || !run.to)
    return;
  if (run.open)
    run.recorder.finish();
  run.open = false;
  const auto start = std::chrono::steady_clock::now();
  pass.store({run.recorder.commands(), run.planned, run.strip, window, {}}, *run.to);
  run.recorder.add(pass.name, vulkan::milliseconds_since(start));
}

void FrameGraph::run(vulkan::PassRecorder &recorder, const PlannedStrip &planned, std::size_t strip,
                     std::size_t windows, const std::function<void(double)> &progress,
                     Measurement &to) const {
  Run run{recorder, planned, strip, &progress, &to};
  for (const Pass &pass : before_)
    run_pass(pass, 0, run);
  for (std::size_t window = 0; window < windows; ++window)
    for (const Pass &pass : of_window_)
      run_pass(pass, window, run);
  for (const Pass &pass : after_)
    run_pass(pass, 0, run);
  if (run.open)
    recorder.finish();
}

void FrameGraph::warm_up(vulkan::PassRecorder &recorder, PlannedStrip planned, std::size_t windows) const {
  planned.strip.columns = planned.strip.rows = 1;
  planned.strip.padded_pixels = padded(1);
  Run run{recorder, planned, 0};
  const auto warm = [&](const Pass &pass, std::size_t window) {
    if (pass.prepare_warm_up)
      pass.prepare_warm_up({recorder.commands(), planned, 0, window, {}});
    run_pass(pass, window, run);
  };
  recorder.begin();
  run.open = true;
  for (const Pass &pass : before_)
    warm(pass, 0);
  for (const std::size_t window : windows_to_warm(windows))
    for (const Pass &pass : of_window_)
      warm(pass, window);
  for (const Pass &pass : after_)
    warm(pass, 0);
  recorder.finish();
}

} // namespace pmdsim
