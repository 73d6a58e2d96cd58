#pragma once
// A pass of a frame: what it reads and writes, and how it is recorded. Passes meet in resources and do not
// name each other.

#include "engine/model/measurement.h"
#include "engine/sampling/raster_blocks.h"
#include "engine/vulkan/buffer.h"

#include <cstdint>
#include <functional>
#include <string>

namespace pmdsim {

// The resources that passes leave for those that come later; each is one or more of StripBuffers.
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
  block_lists = 1u << 8, // of depth records
  run_moments = 1u << 9,
};
using Resources = std::uint32_t;

// Parts of a pass, the last one excluded: runs of sources.
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
  std::function<void(const Recording &)> record; // nothing: all of it is the host's
  // For a pass that may be cut into several submissions: its parts in a window, their number in all windows,
  // and the interactions (samples times sources) of one.
  std::function<Parts(std::size_t window)> parts = {};
  std::uint32_t all_parts = 1;
  std::function<std::uint64_t(const shader::Strip &)> interactions = {};
  // For a warm-up, in which the host has no share: gives the list that a pass works on an entry, or leaves
  // something harmless where the host would leave what the device reads.
  std::function<void(const Recording &)> prepare_warm_up = {};
  // The host's share, once the device is done.
  std::function<void(const Recording &, Measurement &)> store = {};
};

} // namespace pmdsim
