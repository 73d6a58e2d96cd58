#pragma once
// What somebody who named a file that is not there may have meant.

#include <filesystem>
#include <string>

namespace pmdsim {

// The end of a message: ", did you mean \"wall.gltf\"?", or which folder is not there either. Empty where
// nothing is known of it.
std::string absent_file_hint(const std::filesystem::path &file);

} // namespace pmdsim
