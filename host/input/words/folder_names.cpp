#include "host/input/words/folder_names.h"

#include "host/input/words/utf8.h"

#include <cerrno>
#include <dirent.h>
#include <memory>
#include <string_view>

namespace pmdsim {
namespace {

struct Close {
  void operator()(DIR *folder) const { ::closedir(folder); }
};

} // namespace

std::vector<std::string> names_in(const std::filesystem::path &folder, std::error_code &error,
                                  std::size_t most) {
  std::vector<std::string> names;
  error.clear();
  const std::unique_ptr<DIR, Close> open(::opendir(folder.c_str()));
  while (open && names.size() < most) {
    errno = 0;
    const dirent *entry = ::readdir(open.get()); // NOLINT(concurrency-mt-unsafe): its stream is this call's
    if (!entry) {
      error.assign(errno, std::generic_category());
      return names;
    }
    const std::string_view name = entry->d_name;
    if (name != "." && name != "..")
      names.emplace_back(name);
  }
  if (!open)
    error.assign(errno, std::generic_category());
  return names;
}

bool is_plain_name(std::string_view name) {
  return !name.empty() && !name.starts_with('.') && name.find('/') == std::string_view::npos &&
         in_one_line(name) == name;
}

} // namespace pmdsim
