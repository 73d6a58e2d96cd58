#pragma once
// Sizes of memory as people write and read them.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pmdsim {

// "4 GB", "500MB", "1.5 GiB": a number and B, kB, MB, GB or TB (powers of 1000), KiB, MiB, GiB or TiB (of
// 1024), from 1 B to 1e15 B; nothing where the text is none.
std::optional<std::uint64_t> byte_count(std::string_view text);

// Three digits and a unit, a power of 1000: "3.25 GB".
std::string byte_text(std::uint64_t bytes);

} // namespace pmdsim
