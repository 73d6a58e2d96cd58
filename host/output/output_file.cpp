#include "host/output/output_file.h"

#include "engine/error.h"

#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <random>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace pmdsim {
namespace {

std::string reason(int error_number) { return std::generic_category().message(error_number); }

Error write_error(const std::filesystem::path &path, int error_number) {
  return {ExitCode::output, fmt::format("{}: cannot be written: {}", path.string(), reason(error_number))};
}

// Hidden, and random because another run may write to the same directory.
std::filesystem::path temporary_name(const std::filesystem::path &path) {
  std::random_device random;
  return path.parent_path() / fmt::format(".{}.{:08x}.partial", path.filename().string(), random());
}

} // namespace

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

void OutputFile::reserve(std::uint64_t bytes) {
  if (::fallocate(::fileno(stream_), 0, 0, static_cast<off_t>(bytes)) == 0)
    return;
  // Not every file system can; what else may be wrong, the writing tells.
  if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG)
    fail(first_error_ = errno);
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) == bytes.size())
    return;
  if (first_error_ == 0)
    first_error_ = errno;
  fail(first_error_);
}

void OutputFile::seek(std::uint64_t offset) {
  if (::fseeko(stream_, static_cast<off_t>(offset), SEEK_SET) == 0)
    return;
  if (first_error_ == 0)
    first_error_ = errno;
  fail(first_error_);
}

std::uint64_t OutputFile::tell() const {
  const off_t offset = ::ftello(stream_);
  if (offset < 0)
    fail(errno);
  return static_cast<std::uint64_t>(offset);
}

void OutputFile::close() {
  if (std::fflush(stream_) != 0 && first_error_ == 0)
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
