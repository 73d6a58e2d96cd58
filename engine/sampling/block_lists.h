#pragma once
// Blocks of depth records, listed by what there is to do for them: those that every diode reaches, those that
// some diode does not reach, and those that see nothing.

#include "engine/sampling/pass.h"
#include "engine/sampling/strip_memory.h"
#include "engine/vulkan/compute_pipeline.h"
#include "shaders/shared/interface.h"

#include <array>
#include <functional>
#include <span>

namespace pmdsim {

// A list of them, on the device; `kind`: one of shader::blocks_*.
struct SampleBlocks {
  std::uint32_t kind;
  const vulkan::Buffer *list;
};

class BlockLists {
public:
  // `shining`: diodes that may reach a sample. `lists_empty`: else those that see nothing are listed as lit.
  BlockLists(const vulkan::Device &device, const StripBuffers &buffers, std::span<const PlannedStrip> strips,
             std::uint32_t shining, bool lists_empty);

  // Lists the blocks, once it is known how many diodes reach each sample.
  void record(const Recording &at) const;

  // The same by the host, whose memory the lists are in: `kinds` is one of shader::blocks_* for each block,
  // row by row.
  void write(const shader::Strip &strip, std::span<const std::uint8_t> kinds) const;

  SampleBlocks of(std::uint32_t kind) const { return {kind, &lists_[index_of(kind)]}; }

private:
  std::size_t index_of(std::uint32_t kind) const;

  const StripBuffers &buffers_;
  std::uint32_t shining_;
  bool lists_empty_;
  std::array<vulkan::Buffer, shader::block_lists> lists_;
  vulkan::ComputePipeline sort_;
};

// Puts the first block into the list.
std::function<void(const Recording &)> fill_with_one(const SampleBlocks &blocks);

} // namespace pmdsim
