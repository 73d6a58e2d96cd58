#include "host/input/regular_file.h"

#include <cerrno>
#include <system_error>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pmdsim {

namespace {

class FileDescriptor {
public:
  explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
  FileDescriptor(const FileDescriptor &) = delete;
  FileDescriptor &operator=(const FileDescriptor &) = delete;
  ~FileDescriptor() {
    if (descriptor_ >= 0)
      close(descriptor_);
  }
  int get() const { return descriptor_; }

private:
  int descriptor_;
};

std::string reason(int error) {
  return error == ENOENT ? "no such file" : fmt::format("cannot be read ({})", std::generic_category().message(error));
}

std::string read_all(int descriptor, std::size_t size_bytes) {
  std::string bytes(size_bytes, '\0');
  std::size_t done = 0;
  while (done < size_bytes) {
    const ssize_t got = read(descriptor, bytes.data() + done, size_bytes - done);
    if (got < 0 && errno == EINTR)
      continue;
    if (got <= 0)
      break;
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

} // namespace

std::string read_regular_file(const std::filesystem::path &file, std::size_t max_bytes,
                              const Place &named_at) {
  const auto refused = [&](const std::string &why) {
    return input_error(named_at, named_at.file == file ? why : in_quotes(file.string()) + ": " + why);
  };
  // Without O_NONBLOCK, opening a FIFO waits for a writer.
  const FileDescriptor descriptor(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (descriptor.get() < 0)
    throw refused(reason(errno));
  struct stat status {};
  if (fstat(descriptor.get(), &status) != 0)
    throw refused(reason(errno));
  if (S_ISDIR(status.st_mode))
    throw refused("is a directory, expected a file");
  if (!S_ISREG(status.st_mode))
    throw refused("is no regular file");
  if (static_cast<std::size_t>(status.st_size) > max_bytes)
    throw refused(fmt::format("has {} bytes, expected at most {}", status.st_size, max_bytes));
  return read_all(descriptor.get(), static_cast<std::size_t>(status.st_size));
}

} // namespace pmdsim
