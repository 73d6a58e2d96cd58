# Writes the SPIR-V module IN as an array of 32-bit words, pmdsim::shader::spirv::NAME, to OUT.
file(READ ${IN} hex HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words ${hex})
file(WRITE ${OUT} "#include <cstdint>
#include <span>
namespace pmdsim::shader::spirv {
static constexpr std::uint32_t ${NAME}_words[] = {${words}};
extern const std::span<const std::uint32_t> ${NAME};
constinit const std::span<const std::uint32_t> ${NAME}(${NAME}_words);
}
")
