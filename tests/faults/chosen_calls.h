#pragma once
// Which calls of a kind are to fail, where there are too many to try each.

#include <algorithm>
#include <cstddef>
#include <random>
#include <set>

namespace pmdsim::faults {

// Of calls 1 to `calls`, at most `most`: all, or the first ones, the last ones and some between, drawn with
// the seed.
inline std::set<long> chosen_calls(long calls, std::size_t most, unsigned seed) {
  std::set<long> chosen;
  const std::size_t wanted = std::min(static_cast<std::size_t>(calls), most);
  const auto first = static_cast<long>(wanted + 2) / 3, last = static_cast<long>(wanted) / 6;
  for (long i = 1; i <= first; ++i)
    chosen.insert(i);
  for (long i = 0; i < last; ++i)
    chosen.insert(calls - i);
  std::mt19937 random(seed);
  while (chosen.size() < wanted)
    chosen.insert(std::uniform_int_distribution<long>(1, calls)(random));
  return chosen;
}

} // namespace pmdsim::faults
