# Writes the SPIR-V module IN as a C++ array NAME_spirv of 32-bit words to OUT.
file(READ ${IN} hex HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words ${hex})
file(WRITE ${OUT} "#pragma once
#include <array>
#include <cstdint>
namespace pmdsim::shader {
inline constexpr auto ${NAME}_spirv = std::to_array<std::uint32_t>({${words}});
}
")
