#pragma once
// The device's buffers for one strip, made once for the largest and used for all.

#include "engine/model/simulator_options.h"
#include "engine/sampling/raster_blocks.h"
#include "engine/vulkan/buffer.h"

#include <cstddef>
#include <span>
#include <vector>

namespace pmdsim {

struct StripBuffers {
  // With room for rasters that draw on them, whose rows may come in fours (IdRasterPass).
  vulkan::Buffer fragments; // uvec2 a fragment of a distorted strip's block, else empty
  vulkan::Buffer
      ids; // uvec2 a sample (shaders/shared/interface.h): pixel id, triangle id; or its record, uvec4
  vulkan::Buffer position;    // Real[3] a sample, from here on: sub-sample by sub-sample, each padded_pixels
                              // long, but for `sum` of depth records, which is row by row as the records
  vulkan::Buffer surface;     // the vectors a sample that the sum asks for
  vulkan::Buffer backscatter; // float a sample
  vulkan::Buffer
      visibility;     // a window's bundles (source_windows.h), a word a sample each; empty without shadows
  vulkan::Buffer lit; // diodes that reach it, a word a sample; likewise
  // Sum of |terms|, a float a sample, then the others (PixelSum in shaders/signal/demodulation.glsl), where
  // points are summed; and the errors that pixels may have (ClaimsConstants), a vec2 for each frequency.
  // Empty unless an error was asked for.
  vulkan::Buffer terms;
  vulkan::Buffer violations;  // shader::BudgetViolations; likewise
  vulkan::Buffer run_moments; // a plane for each run and moment, a float a sample; where the host sums
  vulkan::Buffer sum;         // plane by plane (shaders/shared/interface.h), a vec4 or vec2 a sample
  vulkan::Buffer channels; // pair by pair (shaders/shared/interface.h), padded_pixels words of each channel
  vulkan::Buffer channels_read; // empty where `channels` is mapped itself
  vulkan::Buffer violations_read;
  vulkan::Buffer ids_read;           // empty where `ids` is mapped itself, or the host has no use for them
  vulkan::Buffer visibility_read;    // empty unless the samples' diodes are asked for
  std::size_t id_bytes = 0;          // a sample, of `ids`
  std::uint32_t terms_of_sample = 0; // floats, of `terms`
};

// A pair of channels as the host reads it, once it is read back: `first`, which is even, and the next, a word
// of either for each pixel.
std::span<const shader::uvec2> pair_for_host(const StripBuffers &buffers, const shader::Strip &strip,
                                             std::uint32_t first);

// The buffer that the raster leaves its IDs in.
inline const vulkan::Buffer &drawn_ids(const StripBuffers &buffers) {
  return buffers.fragments.bytes() > 0 ? buffers.fragments : buffers.ids;
}

// Likewise, IDs or a record a sample.
std::span<const std::byte> ids_for_host(const StripBuffers &buffers);
std::span<const shader::uvec4> records_for_host(const StripBuffers &buffers);

// The layout of what a strip keeps of its samples.
struct SampleLayout {
  bool host_reads_ids;
  std::size_t id_bytes;       // a sample
  std::size_t position_bytes; // likewise, from here on
  std::size_t backscatter_bytes;
  std::size_t surface_vectors;
  std::size_t run_moments; // by the host
  std::size_t sum_bytes;   // of each plane
  std::uint32_t sum_planes;
  std::uint32_t channels;
  std::uint32_t visibility_words; // 0: every diode reaches every sample
  std::uint32_t held_errors;      // the number of frequencies for which pixels' errors are held
  std::uint32_t terms;            // kept of each sample, floats
};

// Buffers of `previous`, whose contents are of no use any more, are taken where they have the right size.
StripBuffers make_strip_buffers(const vulkan::Device &device, const std::vector<PlannedStrip> &strips,
                                const std::vector<RasterBlock> &blocks, const SampleLayout &layout,
                                const SimulatorOptions &options, StripBuffers &&previous);

// The most samples that a strip should have: `usual`, or fewer where that would take buffers of more than 128
// MiB.
std::uint32_t samples_of_a_strip(std::uint32_t usual, std::uint32_t sum_planes, std::uint32_t channels,
                                 std::uint32_t samples_per_pixel);
// The same of so many words of visibility bits a sample.
std::uint32_t samples_of_words(std::uint32_t visibility_words);

inline std::uint32_t sample_count(const shader::Strip &strip) {
  return strip.padded_pixels * strip.samples * strip.samples;
}

// The strip as tiles are cut: depth records lie row by row.
shader::Strip sample_strip(const shader::Strip &strip, bool depth_records);

} // namespace pmdsim
