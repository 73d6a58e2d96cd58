#include "host/input/file/inside_folder.h"

#include <algorithm>

namespace pmdsim {

namespace fs = std::filesystem;

bool lies_inside(const fs::path &folder, const fs::path &name, std::error_code &unresolved) {
  const fs::path there = folder.empty() ? "." : folder; // else an absent file would stay relative
  const fs::path inside = fs::weakly_canonical(there, unresolved);
  const fs::path file = unresolved ? fs::path{} : fs::weakly_canonical(there / name, unresolved);
  return !unresolved && !name.is_absolute() &&
         std::mismatch(inside.begin(), inside.end(), file.begin(), file.end()).first == inside.end();
}

} // namespace pmdsim
