#pragma once
// What a file is that was expected to be another: a scene of another format, an archive, a table.

#include <filesystem>
#include <string>
#include <string_view>

namespace pmdsim {

// "a Wavefront OBJ file", by its first bytes or else by its ending. Empty where neither is known.
std::string kind_of_file(const std::filesystem::path &file, std::string_view bytes);

} // namespace pmdsim
