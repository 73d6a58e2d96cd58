// A library for LD_PRELOAD: calls of the system for memory, files and threads fail as tests/faults/plan.h
// tells. Calls count where the program or a library that it works with makes them. What the Vulkan driver,
// its compiler and the dynamic linker call passes, as they end the process where memory is short, whoever
// uses them; so do libarchive, HDF5 1.10 and Cairo 1.16, which call exit() or crash. What reads fonts and
// fills areas passes, too, as it draws with others, or without, where it cannot.

#include "tests/faults/plan.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <dirent.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <new>
#include <pthread.h>
#include <string_view>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

extern "C" {
void *__libc_malloc(std::size_t bytes);
void *__libc_calloc(std::size_t count, std::size_t bytes);
void *__libc_realloc(void *memory, std::size_t bytes);
void *__libc_memalign(std::size_t alignment, std::size_t bytes);
}

namespace pmdsim::faults {
namespace {

// ---- whose calls count

enum class Module { counted, passed, carrier }; // a carrier calls on behalf of whoever has called it

struct Range {
  std::uintptr_t begin, end;
  Module module;
};

constexpr std::size_t most_ranges = 512;
std::array<Range, most_ranges> ranges;
std::atomic<std::size_t> range_count{0};
pthread_mutex_t ranges_mutex = PTHREAD_MUTEX_INITIALIZER;

Module module_named(std::string_view path) {
  constexpr std::array passed{"libvulkan",   "libLLVM", "libVkLayer", "failing_layer", "libdrm",
                              "libxcb",      "libX11",  "libXau",     "libXdmcp",      "libwayland",
                              "libelf",      "libedit", "libz3",      "ld-linux",      "libsensors",
                              "libexpat",    "libzstd", "libbsd",     "failing_calls", "libfontconfig",
                              "libfreetype", "libhdf5", "libpixman",  "libarchive",    "libcairo"};
  constexpr std::array carriers{"libstdc++", "libc.so", "libgcc_s", "libm.so"};
  for (const char *name : passed)
    if (path.find(name) != path.npos)
      return Module::passed;
  for (const char *name : carriers)
    if (path.find(name) != path.npos)
      return Module::carrier;
  return Module::counted;
}

int add_ranges(dl_phdr_info *info, std::size_t, void *count) {
  auto &known = *static_cast<std::size_t *>(count);
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto &header = info->dlpi_phdr[i];
    if (header.p_type != PT_LOAD || (header.p_flags & PF_X) == 0 || known == most_ranges)
      continue;
    const std::uintptr_t begin = info->dlpi_addr + header.p_vaddr;
    ranges[known++] = {begin, begin + header.p_memsz, module_named(info->dlpi_name)};
  }
  return 0;
}

const Range *range_of(const void *address) {
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  const std::size_t known = range_count;
  for (std::size_t i = 0; i < known; ++i)
    if (at >= ranges[i].begin && at < ranges[i].end)
      return &ranges[i];
  return nullptr;
}

// Code that nobody has loaded is what the driver has compiled.
Module module_of(const void *address) {
  if (const Range *range = range_of(address))
    return range->module;
  pthread_mutex_lock(&ranges_mutex);
  std::size_t known = 0;
  dl_iterate_phdr(add_ranges, &known);
  range_count = known;
  pthread_mutex_unlock(&ranges_mutex);
  const Range *range = range_of(address);
  return range ? range->module : Module::passed;
}

thread_local bool is_inside __attribute__((tls_model("initial-exec"))) = false; // of this library

struct Inside {
  Inside() { is_inside = true; }
  ~Inside() { is_inside = false; }
};

bool counts(const void *caller) {
  const Module module = module_of(caller);
  if (module != Module::carrier)
    return module == Module::counted;
  std::array<void *, 48> frames;
  const int depth = backtrace(frames.data(), static_cast<int>(frames.size()));
  for (int i = 0; i < depth; ++i) {
    const Module of_frame = module_of(frames[static_cast<std::size_t>(i)]);
    const bool is_this_library = i < 3 && of_frame == Module::passed; // at the top
    if (of_frame != Module::carrier && !is_this_library)
      return of_frame == Module::counted;
  }
  return false;
}

// ---- what fails

enum Kind : std::size_t {
  memory,
  file_open,
  file_stream,
  file_read,
  file_write,
  file_sync,
  file_close,
  file_rename,
  file_link,
  file_unlink,
  file_mkdir,
  file_stat,
  file_lock,
  file_reserve,
  file_list,
  memory_map,
  thread_start,
  kind_count
};
constexpr std::array<const char *, kind_count> kind_names{
    "malloc", "open",  "fopen", "read",  "write",     "fsync",   "close", "rename",        "link",
    "unlink", "mkdir", "stat",  "fcntl", "fallocate", "opendir", "mmap",  "pthread_create"};

Plan plan;
std::array<std::atomic<long>, kind_count> calls;
std::atomic<bool> is_ready{false}, has_failed{false};

// Whether this call is to fail; errno tells why then.
bool fails(Kind kind, const void *caller, int usual_error) {
  if (!is_ready || is_inside)
    return false;
  const Inside inside;
  if (!counts(caller))
    return false;
  const long number = ++calls[kind];
  if (!plan.fails(kind_names[kind], number))
    return false;
  has_failed = true;
  errno = plan.code != 0 ? plan.code : usual_error;
  return true;
}

template <class Function>
Function *next(const char *name) {
  return reinterpret_cast<Function *>(dlsym(RTLD_NEXT, name));
}

void append_counts() {
  const Inside inside;
  const char *file = std::getenv(counts_variable);
  const int descriptor = file ? ::open(file, O_WRONLY | O_CREAT | O_APPEND, 0666) : -1;
  if (descriptor < 0)
    return;
  for (std::size_t kind = 0; kind < kind_count; ++kind)
    dprintf(descriptor, "%s %ld\n", kind_names[kind], calls[kind].load());
  if (has_failed)
    dprintf(descriptor, "failed 1\n");
  ::close(descriptor);
}

__attribute__((constructor)) void begin() {
  std::array<void *, 4> frames;
  backtrace(frames.data(), static_cast<int>(frames.size())); // which loads what it needs the first time
  plan = plan_of(std::getenv(plan_variable));
  is_ready = true;
}

__attribute__((destructor)) void end() { append_counts(); }

} // namespace
} // namespace pmdsim::faults

using namespace pmdsim::faults;

// For tests that run in the process: the N-th call from now on fails; a kind of "" ends that. Returns whether
// the call before has failed.
extern "C" __attribute__((visibility("default"))) int pmdsim_fault_arm(const char *kind, long number) {
  const Inside inside;
  plan.kind[0] = '\0';
  const bool failed = has_failed.exchange(false);
  for (std::size_t i = 0; i < kind_count; ++i)
    if (std::strcmp(kind, kind_names[i]) == 0)
      calls[i] = 0;
  plan.first = number;
  plan.all_after = false;
  plan.code = 0;
  std::strncpy(plan.kind, kind, sizeof plan.kind - 1);
  return failed ? 1 : 0;
}

// How many calls of the kind there were since then.
extern "C" __attribute__((visibility("default"))) long pmdsim_fault_calls(const char *kind) {
  for (std::size_t i = 0; i < kind_count; ++i)
    if (std::strcmp(kind, kind_names[i]) == 0)
      return calls[i];
  return -1;
}

#define CALLER __builtin_return_address(0)
#define EXPORTED extern "C" __attribute__((visibility("default")))
// RESULT NAME(PARAMETERS): fails with ERROR and the value FAILURE, else calls the system's NAME(ARGUMENTS).
#define FAILING(KIND, ERROR, FAILURE, RESULT, NAME, PARAMETERS, ARGUMENTS)                                   \
  EXPORTED RESULT NAME PARAMETERS {                                                                          \
    static auto *const system = next<RESULT PARAMETERS>(#NAME);                                              \
    return fails(KIND, CALLER, ERROR) ? FAILURE : system ARGUMENTS;                                          \
  }

// ---- memory

EXPORTED void *malloc(std::size_t bytes) noexcept {
  return fails(memory, CALLER, ENOMEM) ? nullptr : __libc_malloc(bytes);
}
EXPORTED void *calloc(std::size_t count, std::size_t bytes) noexcept {
  return fails(memory, CALLER, ENOMEM) ? nullptr : __libc_calloc(count, bytes);
}
EXPORTED void *realloc(void *old, std::size_t bytes) noexcept {
  return fails(memory, CALLER, ENOMEM) ? nullptr : __libc_realloc(old, bytes);
}
EXPORTED void *aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  return fails(memory, CALLER, ENOMEM) ? nullptr : __libc_memalign(alignment, bytes);
}
EXPORTED int posix_memalign(void **memory_of, std::size_t alignment, std::size_t bytes) noexcept {
  if (fails(memory, CALLER, ENOMEM))
    return ENOMEM;
  *memory_of = __libc_memalign(alignment, bytes);
  return *memory_of ? 0 : ENOMEM;
}

// libstdc++'s own operators would hide from malloc() who has called them.
namespace {
void *allocated(std::size_t bytes, std::size_t alignment, const void *caller) {
  void *const found = fails(memory, caller, ENOMEM) ? nullptr : __libc_memalign(alignment, bytes ? bytes : 1);
  if (!found)
    throw std::bad_alloc();
  return found;
}
} // namespace
__attribute__((visibility("default"))) void *operator new(std::size_t bytes) {
  return allocated(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__, CALLER);
}
__attribute__((visibility("default"))) void *operator new[](std::size_t bytes) {
  return allocated(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__, CALLER);
}
__attribute__((visibility("default"))) void *operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocated(bytes, static_cast<std::size_t>(alignment), CALLER);
}
__attribute__((visibility("default"))) void *operator new[](std::size_t bytes, std::align_val_t alignment) {
  return allocated(bytes, static_cast<std::size_t>(alignment), CALLER);
}
__attribute__((visibility("default"))) void *operator new(std::size_t bytes,
                                                          const std::nothrow_t &) noexcept {
  return fails(memory, CALLER, ENOMEM) ? nullptr : __libc_malloc(bytes ? bytes : 1);
}
__attribute__((visibility("default"))) void *operator new[](std::size_t bytes,
                                                            const std::nothrow_t &) noexcept {
  return fails(memory, CALLER, ENOMEM) ? nullptr : __libc_malloc(bytes ? bytes : 1);
}

FAILING(memory_map, ENOMEM, MAP_FAILED, void *, mmap,
        (void *at, std::size_t bytes, int protection, int flags, int descriptor, off_t offset),
        (at, bytes, protection, flags, descriptor, offset))
FAILING(memory_map, ENOMEM, MAP_FAILED, void *, mmap64,
        (void *at, std::size_t bytes, int protection, int flags, int descriptor, off_t offset),
        (at, bytes, protection, flags, descriptor, offset))

// ---- threads

namespace {
// TBB waits for ever for a thread that did not start where it was called by Embree. The program looks for
// such limits before; a call that fails alone passes here, and all of them do not.
bool is_lone_thread_of_tbb(const void *caller) {
  Dl_info info{};
  return !plan.all_after && dladdr(caller, &info) != 0 && std::strstr(info.dli_fname, "libtbb") != nullptr;
}
} // namespace
EXPORTED int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                            void *with) noexcept {
  static auto *const system =
      next<int(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *)>("pthread_create");
  const bool fails_now = !is_lone_thread_of_tbb(CALLER) && fails(thread_start, CALLER, EAGAIN);
  return fails_now ? EAGAIN : system(thread, attributes, run, with);
}

// ---- files

namespace {
int open_with(const void *caller, const char *path, int flags, mode_t mode) {
  static auto *const system = next<int(int, const char *, int, ...)>("openat");
  return fails(file_open, caller, EMFILE) ? -1 : system(AT_FDCWD, path, flags, mode);
}
mode_t mode_of(int flags, std::va_list rest) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
}
} // namespace
#define FAILING_OPEN(NAME)                                                                                   \
  EXPORTED int NAME(const char *path, int flags, ...) {                                                      \
    std::va_list rest;                                                                                       \
    va_start(rest, flags);                                                                                   \
    const mode_t mode = mode_of(flags, rest);                                                                \
    va_end(rest);                                                                                            \
    return open_with(CALLER, path, flags, mode);                                                             \
  }
FAILING_OPEN(open)
FAILING_OPEN(open64)

FAILING(file_stream, EMFILE, nullptr, FILE *, fopen, (const char *path, const char *mode), (path, mode))
FAILING(file_stream, EMFILE, nullptr, FILE *, fopen64, (const char *path, const char *mode), (path, mode))
FAILING(file_stream, ENOMEM, nullptr, FILE *, fdopen, (int descriptor, const char *mode), (descriptor, mode))
FAILING(file_read, EIO, -1, ssize_t, read, (int descriptor, void *bytes, std::size_t count),
        (descriptor, bytes, count))
FAILING(file_read, EIO, -1, ssize_t, pread, (int descriptor, void *bytes, std::size_t count, off_t at),
        (descriptor, bytes, count, at))
FAILING(file_read, EIO, -1, ssize_t, pread64, (int descriptor, void *bytes, std::size_t count, off_t at),
        (descriptor, bytes, count, at))
FAILING(file_read, EIO, 0, std::size_t, fread,
        (void *bytes, std::size_t size, std::size_t count, FILE *stream), (bytes, size, count, stream))
FAILING(file_write, ENOSPC, -1, ssize_t, write, (int descriptor, const void *bytes, std::size_t count),
        (descriptor, bytes, count))
FAILING(file_write, ENOSPC, -1, ssize_t, pwrite,
        (int descriptor, const void *bytes, std::size_t count, off_t at), (descriptor, bytes, count, at))
FAILING(file_write, ENOSPC, -1, ssize_t, pwrite64,
        (int descriptor, const void *bytes, std::size_t count, off_t at), (descriptor, bytes, count, at))
FAILING(file_write, ENOSPC, -1, ssize_t, pwritev2,
        (int descriptor, const iovec *pieces, int count, off_t at, int flags),
        (descriptor, pieces, count, at, flags))
FAILING(file_write, ENOSPC, -1, ssize_t, pwritev64v2,
        (int descriptor, const iovec *pieces, int count, off_t at, int flags),
        (descriptor, pieces, count, at, flags))
FAILING(file_write, ENOSPC, 0, std::size_t, fwrite,
        (const void *bytes, std::size_t size, std::size_t count, FILE *stream), (bytes, size, count, stream))
FAILING(file_write, ENOSPC, EOF, int, fputs, (const char *text, FILE *stream), (text, stream))
FAILING(file_write, ENOSPC, EOF, int, fflush, (FILE * stream), (stream))
FAILING(file_sync, EIO, -1, int, fsync, (int descriptor), (descriptor))
FAILING(file_sync, EIO, -1, int, fdatasync, (int descriptor), (descriptor))
FAILING(file_sync, EIO, -1, int, syncfs, (int descriptor), (descriptor))
FAILING(file_rename, EIO, -1, int, rename, (const char *from, const char *to), (from, to))
FAILING(file_link, EIO, -1, int, link, (const char *from, const char *to), (from, to))
FAILING(file_link, EIO, -1, int, linkat,
        (int from_folder, const char *from, int to_folder, const char *to, int flags),
        (from_folder, from, to_folder, to, flags))
FAILING(file_unlink, EIO, -1, int, unlink, (const char *path), (path))
FAILING(file_unlink, EIO, -1, int, remove, (const char *path), (path))
FAILING(file_mkdir, EIO, -1, int, mkdir, (const char *path, mode_t mode), (path, mode))
FAILING(file_stat, EIO, -1, int, stat, (const char *path, struct stat *status), (path, status))
FAILING(file_stat, EIO, -1, int, lstat, (const char *path, struct stat *status), (path, status))
FAILING(file_stat, EIO, -1, int, fstat, (int descriptor, struct stat *status), (descriptor, status))
FAILING(file_stat, EIO, -1, int, stat64, (const char *path, struct stat64 *status), (path, status))
FAILING(file_stat, EIO, -1, int, lstat64, (const char *path, struct stat64 *status), (path, status))
FAILING(file_stat, EIO, -1, int, fstat64, (int descriptor, struct stat64 *status), (descriptor, status))
FAILING(file_reserve, ENOSPC, -1, int, fallocate, (int descriptor, int mode, off_t at, off_t bytes),
        (descriptor, mode, at, bytes))
FAILING(file_reserve, ENOSPC, -1, int, fallocate64, (int descriptor, int mode, off64_t at, off64_t bytes),
        (descriptor, mode, at, bytes))
FAILING(file_list, EACCES, nullptr, DIR *, opendir, (const char *path), (path))
FAILING(file_list, EIO, nullptr, dirent *, readdir, (DIR * folder), (folder))
FAILING(file_list, EIO, nullptr, dirent64 *, readdir64, (DIR * folder), (folder))

// Closed it is, whatever it says: as Linux does it.
EXPORTED int fclose(FILE *stream) {
  static auto *const system = next<int(FILE *)>("fclose");
  const bool fails_now = fails(file_close, CALLER, EIO);
  const int error_number = errno;
  const int result = system(stream);
  if (fails_now)
    errno = error_number;
  return fails_now ? EOF : result;
}

namespace {
int lock_with(const void *caller, int descriptor, int command, void *argument) {
  static auto *const system = next<int(int, int, ...)>("fcntl64");
  return fails(file_lock, caller, ENOLCK) ? -1 : system(descriptor, command, argument);
}
} // namespace
#define FAILING_FCNTL(NAME)                                                                                  \
  EXPORTED int NAME(int descriptor, int command, ...) {                                                      \
    std::va_list rest;                                                                                       \
    va_start(rest, command);                                                                                 \
    void *const argument = va_arg(rest, void *);                                                             \
    va_end(rest);                                                                                            \
    return lock_with(CALLER, descriptor, command, argument);                                                 \
  }
FAILING_FCNTL(fcntl)
FAILING_FCNTL(fcntl64)
