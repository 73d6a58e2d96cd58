#include "host/output/files/durable.h"

#include "host/output/files/output_file.h"

#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

namespace pmdsim {
namespace {

bool means_not_able(int error_number) {
  return error_number == EINVAL || error_number == ENOSYS || error_number == EOPNOTSUPP ||
         error_number == EROFS;
}

// A directory that may be entered but not listed cannot be opened: then nothing can be waited for.
void sync(const std::filesystem::path &directory, int (*until_done)(int)) {
  const std::filesystem::path opened = directory.empty() ? "." : directory;
  const int descriptor = ::open(opened.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  int error_number = descriptor < 0 ? errno : 0;
  if (descriptor >= 0) {
    if (until_done(descriptor) != 0 && !means_not_able(errno))
      error_number = errno;
    ::close(descriptor);
  }
  if (error_number != 0 && error_number != EACCES)
    throw write_error(opened, error_number);
}

} // namespace

void sync_file_system(const std::filesystem::path &directory) { sync(directory, ::syncfs); }

void sync_names(const std::filesystem::path &directory) { sync(directory, ::fsync); }

void sync_file(int descriptor, const std::filesystem::path &file) {
  if (::fsync(descriptor) != 0 && !means_not_able(errno))
    throw write_error(file, errno);
}

} // namespace pmdsim
