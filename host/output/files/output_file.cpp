#include "host/output/files/output_file.h"

#include "host/output/files/durable.h"

#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <random>
#include <sys/stat.h>
#include <sys/uio.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace pmdsim {
namespace {

constexpr std::size_t many_bytes = std::size_t{1} << 18;
// RWF_DONTCACHE of Linux 6.14, which older headers lack: pages are written to the disk at once and then given
// back, so that the next ones need no new memory.
constexpr int uncached = 0x80;

constexpr std::string_view temporary_ending = ".partial";
constexpr std::size_t random_digits = 8;

} // namespace

Error write_error(const std::filesystem::path &path, const std::string &reason, Lacking lacking) {
  return {lacking == Lacking::memory ? ExitCode::out_of_memory : ExitCode::output,
          fmt::format("{}: cannot be written: {}", path.string(), reason)};
}

Error write_error(const std::filesystem::path &path, int error_number) {
  return write_error(path, std::generic_category().message(error_number),
                     error_number == ENOMEM ? Lacking::memory : Lacking::other);
}

void refuse_what_is_no_file(const std::filesystem::path &path) {
  std::error_code ignored;
  using enum std::filesystem::file_type;
  const auto type = std::filesystem::symlink_status(path, ignored).type();
  if (type == fifo || type == character || type == block || type == socket)
    throw write_error(path, "is no file, expected the name of one", Lacking::other);
}

std::filesystem::path temporary_name(const std::filesystem::path &path) {
  std::random_device random;
  return path.parent_path() /
         fmt::format(".{}.{:0{}x}{}", path.filename().string(), random(), random_digits, temporary_ending);
}

std::optional<std::string> name_of_temporary(const std::string &temporary) {
  constexpr std::size_t added = 1 + random_digits + temporary_ending.size(); // behind the name
  if (temporary.size() <= 1 + added || temporary.front() != '.' || !temporary.ends_with(temporary_ending))
    return std::nullopt;
  const std::string random = temporary.substr(temporary.size() - added, 1 + random_digits);
  if (random.front() != '.' || random.find_first_not_of("0123456789abcdef", 1) != std::string::npos)
    return std::nullopt;
  return temporary.substr(1, temporary.size() - 1 - added);
}

OutputFile::OutputFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(temporary_name(path_)) {
  const int descriptor = ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0)
    fail(errno);
  stream_ = ::fdopen(descriptor, "w+b");
  if (!stream_) {
    const int error_number = errno;
    ::close(descriptor);
    ::unlink(temporary_.c_str());
    fail(error_number);
  }
}

OutputFile::~OutputFile() {
  if (stream_)
    std::fclose(stream_);
  if (!temporary_.empty())
    ::unlink(temporary_.c_str());
}

void OutputFile::fail(int error_number) const { throw write_error(path_, error_number); }

void OutputFile::fail_for_good() {
  if (first_error_ == 0)
    first_error_ = errno;
  fail(first_error_);
}

void OutputFile::reserve(std::uint64_t bytes) {
  if (::fallocate(::fileno(stream_), 0, 0, static_cast<off_t>(bytes)) == 0)
    return;
  // Not every file system can; what else may be wrong, the writing tells.
  if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG)
    fail(first_error_ = errno);
}

std::size_t OutputFile::write_uncached(std::string_view bytes) {
  const off_t start = std::fflush(stream_) == 0 ? ::ftello(stream_) : -1;
  std::size_t written = 0;
  while (start >= 0 && written < bytes.size()) {
    iovec rest{const_cast<char *>(bytes.data()) + written, bytes.size() - written};
    const ssize_t count =
        ::pwritev2(::fileno(stream_), &rest, 1, start + static_cast<off_t>(written), uncached);
    if (count <= 0)
      break; // not every system can; what else may be wrong, writing the rest tells
    written += static_cast<std::size_t>(count);
  }
  if (written > 0)
    seek(static_cast<std::uint64_t>(start) + written);
  return written;
}

void OutputFile::write(std::string_view bytes) {
  if (bytes.size() >= many_bytes)
    bytes.remove_prefix(write_uncached(bytes));
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size())
    fail_for_good();
}

void OutputFile::seek(std::uint64_t offset) {
  if (::fseeko(stream_, static_cast<off_t>(offset), SEEK_SET) != 0)
    fail_for_good();
}

std::uint64_t OutputFile::tell() const {
  const off_t offset = ::ftello(stream_);
  if (offset < 0)
    fail(errno);
  return static_cast<std::uint64_t>(offset);
}

void OutputFile::sync() {
  if (std::fflush(stream_) != 0)
    fail_for_good();
  sync_file(::fileno(stream_), path_);
}

void OutputFile::close() {
  if (std::fflush(stream_) != 0 && first_error_ == 0)
    first_error_ = errno;
  struct stat status {};
  if (::fstat(::fileno(stream_), &status) == 0)
    size_bytes_ = static_cast<std::uint64_t>(status.st_size);
  else if (first_error_ == 0)
    first_error_ = errno;
  if (std::fclose(std::exchange(stream_, nullptr)) != 0 && first_error_ == 0)
    first_error_ = errno;
  if (first_error_ != 0)
    fail(first_error_);
}

void OutputFile::check_publishable() const {
  std::error_code absent;
  if (std::filesystem::is_directory(std::filesystem::symlink_status(path_, absent)))
    fail(EISDIR);
}

void OutputFile::publish() {
  if (::rename(temporary_.c_str(), path_.c_str()) != 0)
    fail(errno);
  temporary_.clear();
}

void OutputFile::withdraw() noexcept { ::unlink(path_.c_str()); }

void remove_file(const std::filesystem::path &path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT)
    throw write_error(path, errno);
}

} // namespace pmdsim
