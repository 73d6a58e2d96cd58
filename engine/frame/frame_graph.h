#pragma once
// A frame's passes as a written list, each with what it reads and writes. The order is the list's; barriers,
// the cutting into submissions and the warm-up follow from it.

#include "engine/sampling/pass.h"
#include "engine/vulkan/commands.h"

#include <functional>
#include <vector>

namespace pmdsim {

class FrameGraph {
public:
  // `left`: the resources that another list has left to be read.
  explicit FrameGraph(Resources left = no_resource) : written_(left) {}

  // Add passes before the windows of visibility bits, to each window, and after all of them; in this order.
  // Throws std::logic_error where a pass reads what none before it has written.
  void add_before(Pass pass);
  void add_to_window(Pass pass);
  void add_after(Pass pass);

  // Runs a strip's passes, from the first to the host's share of the last. `progress` is told the fraction of
  // a pass's parts that is done, 0 to 1.
  void run(vulkan::PassRecorder &recorder, const PlannedStrip &planned, std::size_t strip,
           std::size_t windows, const std::function<void(double)> &progress, Measurement &to) const;

  // Runs every pass once over a single pixel, and each that has a first and a later form twice: lavapipe
  // compiles a shader at its first dispatch. The pixel is put into every list; its values are of no interest.
  void warm_up(vulkan::PassRecorder &recorder, PlannedStrip planned, std::size_t windows) const;

private:
  struct Run {
    vulkan::PassRecorder &recorder;
    const PlannedStrip &planned;
    std::size_t strip;
    const std::function<void(double)> *progress = nullptr; // null in a warm-up, as below
    Measurement *to = nullptr;
    bool open = false;                                   // commands are being recorded
    Resources written = no_resource, read = no_resource; // since the last barrier
  };

  void check(const Pass &pass);
  void record_pass(const Pass &pass, std::size_t window, Run &run) const;
  void run_pass(const Pass &pass, std::size_t window, Run &run) const;
  void run_parts(const Pass &pass, std::size_t window, Parts parts, Run &run) const;

  std::vector<Pass> before_, of_window_, after_;
  Resources written_ = no_resource;
};

} // namespace pmdsim
