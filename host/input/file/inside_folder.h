#pragma once
// Files that a stranger's file names: in its own folder or below, and nowhere else.

#include <filesystem>
#include <system_error>

namespace pmdsim {

// Whether a file, which `name` names in `folder`, lies there or below when links are followed; a name that
// starts at the root is taken to lead out. `unresolved` tells where that cannot be found out.
bool lies_inside(const std::filesystem::path &folder, const std::filesystem::path &name,
                 std::error_code &unresolved);

} // namespace pmdsim
