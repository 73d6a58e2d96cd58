#pragma once
// What a glTF URI leads to: a file in the scene's folder, or bytes in the URI itself.

#include "host/input/file/input_error.h"

#include <filesystem>
#include <string>
#include <vector>

namespace pmdsim {

using Bytes = std::vector<unsigned char>;

// The folder of a scene's file.
std::filesystem::path folder_of(const std::filesystem::path &file);

// The file in `folder` that a relative reference names. Throws Error (input) at `place`: also for a URI that
// leads out of the folder, by "..", an absolute path or a link, and for one with a scheme.
std::filesystem::path file_in_folder(const std::string &uri, const std::filesystem::path &folder,
                                     const Place &place);

} // namespace pmdsim
