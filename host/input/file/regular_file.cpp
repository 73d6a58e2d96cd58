#include "host/input/file/regular_file.h"

#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <system_error>
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
  return error == ENOENT ? "no such file"
                         : fmt::format("cannot be read ({})", std::generic_category().message(error));
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

Error refused(const std::filesystem::path &file, const std::string &why, const AnyPlace &named_at) {
  const auto &named_in = std::visit(
      [](const auto &place) -> const auto & { return place.file; }, named_at);
  return input_error(named_at, named_in == file ? why : in_quotes(file.string()) + ": " + why);
}

// The system takes a NUL for the end of a name.
const std::filesystem::path &without_nul(const std::filesystem::path &file, const AnyPlace &named_at) {
  if (file.native().find('\0') != std::string::npos)
    throw refused(file, "expected a file's name without NUL", named_at);
  return file;
}

// A regular file, open for reading.
class RegularFile {
public:
  RegularFile(const std::filesystem::path &file, const AnyPlace &named_at)
      // Without O_NONBLOCK, opening a FIFO waits for a writer.
      : descriptor_(open(without_nul(file, named_at).c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {
    struct stat status {};
    if (descriptor_.get() < 0 || fstat(descriptor_.get(), &status) != 0)
      throw refused(file, reason(errno), named_at);
    if (S_ISDIR(status.st_mode))
      throw refused(file, "is a directory, expected a file", named_at);
    if (!S_ISREG(status.st_mode))
      throw refused(file, "is no regular file", named_at);
    size_bytes_ = static_cast<std::size_t>(status.st_size);
  }

  std::size_t size_bytes() const { return size_bytes_; }
  std::string front(std::size_t length_bytes) const { return read_all(descriptor_.get(), length_bytes); }

private:
  FileDescriptor descriptor_;
  std::size_t size_bytes_ = 0;
};

} // namespace

std::string read_regular_file(const std::filesystem::path &file, std::size_t max_bytes,
                              const AnyPlace &named_at) {
  const RegularFile opened(file, named_at);
  if (opened.size_bytes() > max_bytes)
    throw refused(file, fmt::format("has {} bytes, expected at most {}", opened.size_bytes(), max_bytes),
                  named_at);
  return opened.front(opened.size_bytes());
}

std::string read_front_of_regular_file(const std::filesystem::path &file, std::size_t length_bytes,
                                       const Place &named_at) {
  const RegularFile opened(file, named_at);
  if (opened.size_bytes() < length_bytes)
    throw refused(file, fmt::format("has {} bytes, expected at least {}", opened.size_bytes(), length_bytes),
                  named_at);
  return opened.front(length_bytes);
}

} // namespace pmdsim
