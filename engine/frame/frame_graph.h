#pragma once
// A frame's passes as a written list, each with what it reads and writes. The order is the list's; barriers,
// the cutting into submissions and the warm-up follow from it.

#include "engine/model/measurement.h"
#include "engine/sampling/strips.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/pass_recorder.h"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pmdsim {

// What passes leave for those that come later; each is one or more of StripBuffers.
enum Resource : std::uint32_t {
  no_resource = 0,
  ids = 1u << 0,             // of each sample's pixel and triangle; its depth where the record is that
  points = 1u << 1,          // and the surfaces there
  visibility_bits = 1u << 2, // of a window's sources
  visibility_counts = 1u << 3,
  pixel_lists = 1u << 4,
  sums = 1u << 5,
  terms = 1u << 6, // sums of the terms' sizes, for bounds
  channels = 1u << 7,
};
using Resources = std::uint32_t;

// Parts of a pass, the last one excluded: batches of sources.
struct Parts {
  std::uint32_t first = 0, last = 1;
};

// Where a pass is recorded.
struct Recording {
  const vk::raii::CommandBuffer &commands;
  const PlannedStrip &planned;
  std::size_t strip;  // index of the planned one
  std::size_t window; // of visibility bits
  Parts parts;

  const shader::Strip &of_strip() const { return planned.strip; }
};

struct Pass {
  std::string name; // the key of its time in Measurement::passes
  Resources reads, writes;
  std::function<void(const Recording &)> record;
  // Of a pass that may be cut into several submissions: its parts in a window, how many it has in all
  // windows, and the interactions (samples times sources) of one.
  std::function<Parts(std::size_t window)> parts = {};
  std::uint32_t all_parts = 1;
  std::function<std::uint64_t(const shader::Strip &)> interactions = {};
  const vulkan::Buffer *list = nullptr; // of pixels that it works on; else it works on all
  // The host's share, once the device is done.
  std::function<void(const Recording &, Measurement &)> store = {};
};

class FrameGraph {
public:
  // `left`: what another list has left to be read.
  explicit FrameGraph(Resources left = no_resource) : written_(left) {}

  // Passes before the windows of visibility bits, of each window, and after all of them; in this order.
  // Throws std::logic_error where a pass reads what none before it has written.
  void add_before(Pass pass);
  void add_to_window(Pass pass);
  void add_after(Pass pass);

  // A strip's passes, from the first to the host's share of the last. `progress` hears of parts done, 0 to 1.
  void run(vulkan::PassRecorder &recorder, const PlannedStrip &planned, std::size_t strip,
           std::size_t windows, const std::function<void(double)> &progress, Measurement &to) const;

  // Every pass once over a single pixel, and each that has a first and a later form twice: lavapipe compiles
  // a shader at its first dispatch. The pixel is put into every list; what becomes of it is of no interest.
  void warm_up(vulkan::PassRecorder &recorder, PlannedStrip planned, std::size_t windows) const;

private:
  struct Run {
    vulkan::PassRecorder &recorder;
    const PlannedStrip &planned;
    std::size_t strip;
    const std::function<void(double)> *progress = nullptr; // of a warm-up, as below
    Measurement *to = nullptr;
    bool open = false;                                   // commands are being recorded
    Resources written = no_resource, read = no_resource; // since the last barrier
  };

  void check(const Pass &pass);
  void run_pass(const Pass &pass, std::size_t window, Run &run) const;
  void run_parts(const Pass &pass, std::size_t window, Parts parts, Run &run) const;

  std::vector<Pass> before_, of_window_, after_;
  Resources written_ = no_resource;
};

} // namespace pmdsim
