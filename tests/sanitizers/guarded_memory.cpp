// A library for LD_PRELOAD: what lavapipe allocates for a Vulkan device lies between pages that nobody may
// touch, is full of bytes that nobody wrote, and is never given again after it was freed. So a shader that
// reads or writes beyond a buffer, or one that is gone, ends the process with SIGSEGV, and one that takes for
// zero what nothing has written computes nonsense.

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <map>
#include <mutex>
#include <sys/mman.h>

extern "C" {
void *__libc_memalign(std::size_t alignment, std::size_t bytes);
void __libc_free(void *memory);
}

namespace {

constexpr std::size_t page_bytes = 4096;
constexpr std::size_t all_bytes = std::size_t{4} << 40; // of addresses: untouched pages take no memory
// As buffer references of the shaders are aligned: up to 15 bytes after a buffer's end pass.
constexpr std::size_t alignment_bytes = 16;
constexpr int unwritten = 0xcb;

struct Pages {
  char *begin;
  std::size_t bytes;
};

class GuardedMemory {
public:
  // As posix_memalign, or null.
  void *allocate(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    const Pages pages{next_, (bytes + page_bytes - 1) / page_bytes * page_bytes};
    if (pages.bytes + page_bytes > static_cast<std::size_t>(begin_ + all_bytes - next_) ||
        ::mprotect(pages.begin, pages.bytes, PROT_READ | PROT_WRITE) != 0)
      return nullptr;
    next_ += pages.bytes + page_bytes;
    std::memset(pages.begin, unwritten, pages.bytes);
    char *const memory = pages.begin + (pages.bytes - bytes) / alignment_bytes * alignment_bytes;
    used_[memory] = pages;
    return memory;
  }

  bool has(const void *memory) const { return memory >= begin_ && memory < begin_ + all_bytes; }

  void free(void *memory) {
    const std::lock_guard lock(mutex_);
    const auto found = used_.find(memory);
    if (found == used_.end()) {
      std::fputs("guarded_memory: freed twice\n", stderr);
      std::abort();
    }
    ::madvise(found->second.begin, found->second.bytes, MADV_DONTNEED);
    ::mprotect(found->second.begin, found->second.bytes, PROT_NONE);
    used_.erase(found);
  }

private:
  static char *reserve() {
    void *const memory =
        ::mmap(nullptr, all_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) {
      std::perror("guarded_memory");
      std::abort();
    }
    return static_cast<char *>(memory);
  }

  std::mutex mutex_;
  std::map<void *, Pages> used_;
  char *const begin_ = reserve();
  char *next_ = begin_ + page_bytes;
};

std::atomic<GuardedMemory *> guarded_memory; // from the driver's first allocation on, to the process's end

bool is_the_driver(const void *caller) {
  Dl_info module{};
  return ::dladdr(caller, &module) != 0 && std::strstr(module.dli_fname, "libvulkan_lvp") != nullptr;
}

// Whole pages are what lavapipe asks for as a device's memory, and for nothing else.
bool is_for_a_device(std::size_t alignment, std::size_t bytes, const void *caller) {
  return alignment >= page_bytes && bytes > 0 && is_the_driver(caller);
}

void *allocate_guarded(std::size_t bytes) {
  static GuardedMemory &memory = *(guarded_memory = new GuardedMemory);
  return memory.allocate(bytes);
}

} // namespace

extern "C" __attribute__((visibility("default"))) int posix_memalign(void **memory, std::size_t alignment,
                                                                     std::size_t bytes) noexcept {
  void *const allocated = is_for_a_device(alignment, bytes, __builtin_return_address(0))
                              ? allocate_guarded(bytes)
                              : __libc_memalign(alignment, bytes);
  if (allocated == nullptr)
    return ENOMEM;
  *memory = allocated;
  return 0;
}

extern "C" __attribute__((visibility("default"))) void free(void *memory) noexcept {
  GuardedMemory *const guarded = guarded_memory;
  if (guarded != nullptr && guarded->has(memory))
    guarded->free(memory);
  else
    __libc_free(memory);
}
