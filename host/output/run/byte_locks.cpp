#include "host/output/run/byte_locks.h"

#include "host/output/files/durable.h"
#include "host/output/files/output_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace pmdsim {
namespace {

struct flock of_byte(std::uint64_t byte, short type) {
  struct flock range {};
  range.l_type = type;
  range.l_whence = SEEK_SET;
  range.l_start = static_cast<off_t>(byte);
  range.l_len = 1;
  return range;
}

short type_of(ByteLocks::Kind kind) { return kind == ByteLocks::Kind::shared ? F_RDLCK : F_WRLCK; }

bool means_no_locks(int error_number) {
  constexpr std::array unsupported{ENOLCK, ENOSYS, EOPNOTSUPP, EINVAL};
  return std::ranges::find(unsupported, error_number) != unsupported.end();
}

} // namespace

ByteLocks::~ByteLocks() {
  if (descriptor_ >= 0)
    ::close(descriptor_);
}

ByteLocks::ByteLocks(ByteLocks &&other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), works_(other.works_) {}

ByteLocks &ByteLocks::operator=(ByteLocks &&other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(works_, other.works_);
  return *this;
}

bool ByteLocks::set(std::uint64_t byte, short type) {
  if (!works_)
    return true;
  struct flock range = of_byte(byte, type);
  while (::fcntl(descriptor_, F_OFD_SETLK, &range) != 0) {
    if (errno == EAGAIN || errno == EACCES)
      return false;
    if (means_no_locks(errno)) {
      works_ = false;
      return true;
    }
    if (errno != EINTR)
      throw Error(ExitCode::output, fmt::format("output directory cannot be locked: {}",
                                                std::generic_category().message(errno)));
  }
  return true;
}

bool ByteLocks::try_lock(std::uint64_t byte, Kind kind) { return set(byte, type_of(kind)); }
void ByteLocks::unlock(std::uint64_t byte) { set(byte, F_UNLCK); }

bool ByteLocks::is_held_by_another(std::uint64_t byte) const {
  struct flock range = of_byte(byte, F_WRLCK);
  return works_ && ::fcntl(descriptor_, F_OFD_GETLK, &range) == 0 && range.l_type != F_UNLCK;
}

bool ByteLocks::is_at(const std::filesystem::path &path) const {
  struct stat mine {
  }, there{};
  return ::fstat(descriptor_, &mine) == 0 && ::stat(path.c_str(), &there) == 0 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

std::string ByteLocks::content(std::size_t max_bytes) const {
  std::string text;
  std::array<char, 1 << 16> piece{};
  while (text.size() < max_bytes) {
    const std::size_t wanted = std::min(piece.size(), max_bytes - text.size());
    const ssize_t count = ::pread(descriptor_, piece.data(), wanted, static_cast<off_t>(text.size()));
    if (count <= 0)
      break; // what cannot be read is not what anyone expects there
    text.append(piece.data(), static_cast<std::size_t>(count));
  }
  return text;
}

void ByteLocks::write(std::string_view text, const std::filesystem::path &path) const {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor_, text.data(), text.size());
    if (count < 0 && errno == EINTR)
      continue;
    if (count <= 0)
      throw write_error(path, errno);
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  sync_file(descriptor_, path);
}

} // namespace pmdsim
