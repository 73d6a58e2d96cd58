#pragma once
// Locks by which processes on one machine or several agree about a folder. Each is one byte of a file; the
// operating system gives it back when its process ends, however it ends.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace pmdsim {

// An open file and the locks that are held through it: open-file-description locks of fcntl(2), which reach
// over NFS, too. Bytes beyond the file's end can be locked like others.
class ByteLocks {
public:
  enum class Kind { shared, exclusive };

  // Takes over the descriptor, of a file that is open for reading; for writing, too, where exclusive locks
  // are wanted.
  explicit ByteLocks(int descriptor) : descriptor_(descriptor) {}
  ~ByteLocks();
  ByteLocks(ByteLocks &&other) noexcept;
  ByteLocks &operator=(ByteLocks &&other) noexcept;

  // False where another holds it. Turns a lock that is held into one of the other kind, which leaves it as it
  // was where it fails. Where the file system has no locks every one is granted, and works() says so from
  // then on. Throws Error (output).
  bool try_lock(std::uint64_t byte, Kind kind);
  void unlock(std::uint64_t byte);
  // Whether another holds it, of any kind.
  bool is_held_by_another(std::uint64_t byte) const;
  bool works() const { return works_; }

  // Whether the file is the one of that name, which may have been replaced since.
  bool is_at(const std::filesystem::path &path) const;
  // Its first bytes, so many at most.
  std::string content(std::size_t max_bytes) const;
  // Returns when the disk has it. Throws Error (output) that names `path`.
  void write(std::string_view text, const std::filesystem::path &path) const;

private:
  bool set(std::uint64_t byte, short type);

  int descriptor_; // -1: moved from
  bool works_ = true;
};

} // namespace pmdsim
