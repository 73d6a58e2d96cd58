#pragma once
// How the device lays out a strip's channels: the areas of DeviceSlot, which follow from the rows of
// engine/model/channels.h, and what the demodulation is told of each modulation frequency.

#include "engine/light/tones.h"
#include "engine/model/accuracy.h"
#include "engine/model/channels.h"

#include <optional>
#include <vector>

namespace pmdsim {

struct ChannelLayout {
  explicit ChannelLayout(const Modulation &modulation);

  std::uint32_t frequencies; // that have phases
  std::uint32_t taps;        // that are kept, of each frequency
  bool lit;                  // the area of shadows is there
  bool bounds;               // the areas of bounds are there
  bool rests;                // a pair behind each frequency's bounds: of distance_m and of range_m
  bool mean;                 // the area of the mean is there

  // The number of all channels, and those at which areas begin; even numbers.
  std::uint32_t channels() const;
  std::uint32_t first_channel(std::uint32_t frequency) const;
  std::uint32_t rest_channels(std::uint32_t frequency) const;
  std::uint32_t lit_channel() const;
  std::uint32_t mean_channel() const;

  bool holds(const ChannelRow &row) const;
  // The number of a channel that it holds.
  std::uint32_t number(const ChannelIndex &of) const;
};

// Amplitudes are per unit of the mean return, in which diodes count relative to the strongest.
std::vector<shader::Frequency> frequency_records(const Modulation &modulation, double largest_intensity_w_sr,
                                                 const std::optional<ErrorBound> &bound,
                                                 std::uint32_t diodes);

} // namespace pmdsim
