#pragma once
// Some of the diodes, counted through all illuminators.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pmdsim::reference {

class DiodeSet {
public:
  // Empty, of `diodes` that there are.
  explicit DiodeSet(std::size_t diodes) : words_(word_count(diodes)) {}

  static std::size_t word_count(std::size_t diodes) { return (diodes + 31) / 32; }

  void add(std::size_t diode) { words_[diode / 32] |= 1U << diode % 32; }
  bool has(std::size_t diode) const { return (words_[diode / 32] >> diode % 32 & 1U) != 0; }

  std::size_t count() const {
    std::size_t count = 0;
    for (const std::uint32_t word : words_)
      count += static_cast<std::size_t>(std::popcount(word));
    return count;
  }

  // As Measurement::sample_reached holds them.
  const std::vector<std::uint32_t> &words() const { return words_; }

private:
  std::vector<std::uint32_t> words_;
};

} // namespace pmdsim::reference
