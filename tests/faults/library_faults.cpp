// The shared library while one call of the system fails: thousands of calls, in one process, which goes on
// using it. Run with failing_calls before all other libraries, as library_test.cpp does. Arguments: a setup,
// and how many calls of each kind are to fail. Prints a line for each kind and for what was wrong; ends with
// 1 where anything was.

#include "host/library/pmdsim.h"
#include "tests/faults/chosen_calls.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dirent.h>
#include <dlfcn.h>
#include <malloc.h>
#include <map>
#include <string>
#include <vector>

namespace {

using Arm = int(const char *, long);
using Calls = long(const char *);
Arm *arm = nullptr;
Calls *calls_of = nullptr;
int wrong = 0;

void tell_wrong(const std::string &where, const std::string &what) {
  std::printf("WRONG %s: %s\n", where.c_str(), what.c_str());
  ++wrong;
}

using Values = std::vector<float>;

struct Outcome {
  pmdsim_status status;
  std::string message;
};

// What a user does with a setup: load, change, measure, look.
Outcome use(pmdsim_simulator *simulator, const std::string &setup, Values &values) {
  pmdsim_frame *frame = nullptr;
  pmdsim_channel channel{};
  channel.struct_size = sizeof channel;
  pmdsim_status status = pmdsim_simulator_load(simulator, setup.c_str());
  if (status == PMDSIM_OK)
    status = pmdsim_simulator_set(simulator, R"({"sensors/0/focal_length_m": 0.0019})");
  if (status == PMDSIM_OK)
    status = pmdsim_render(simulator, 0, 1, nullptr, &frame);
  if (status == PMDSIM_OK)
    status = pmdsim_frame_find(frame, "distance_m", &channel);
  if (status == PMDSIM_OK) {
    const auto *const first = static_cast<const float *>(channel.values);
    values.assign(first, first + std::size_t{channel.rows} * channel.columns);
  }
  const std::string message = status == PMDSIM_OK ? "" : pmdsim_error_message();
  pmdsim_frame_destroy(frame);
  return {status, message};
}

bool are_same(const Values &a, const Values &b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

std::size_t open_files() {
  std::size_t count = 0;
  DIR *folder = ::opendir("/proc/self/fd");
  while (folder && ::readdir(folder))
    ++count;
  ::closedir(folder);
  return count;
}

bool is_right(const std::string &kind, pmdsim_status status) {
  if (status == PMDSIM_OK) // it was no loss
    return true;
  const bool of_memory = kind == "malloc" || kind == "mmap" || kind == "pthread_create";
  return status == (of_memory ? PMDSIM_OUT_OF_MEMORY : PMDSIM_BAD_INPUT);
}

void fail_calls(pmdsim_simulator *simulator, const std::string &setup, const std::string &kind,
                std::size_t most) {
  Values expected, values;
  arm(kind.c_str(), -1);
  use(simulator, setup, expected);
  const long calls = calls_of(kind.c_str());
  arm("", 0);
  std::map<int, int> ends;
  int tried = 0;
  const std::size_t files_before = open_files();
  std::size_t bytes_before = ::mallinfo2().uordblks;
  for (const long call : pmdsim::faults::chosen_calls(calls, most, 1)) {
    const std::string where = kind + ":" + std::to_string(call);
    arm(kind.c_str(), call);
    const auto [status, message] = use(simulator, setup, values);
    if (arm("", 0) == 0)
      continue;
    ++tried;
    ++ends[status];
    if (!is_right(kind, status))
      tell_wrong(where, "status " + std::to_string(status) + ", " + message);
    else if (status != PMDSIM_OK && (message.empty() || message.find('\n') != message.npos))
      tell_wrong(where, "no line that tells why: " + message);
    else if (status == PMDSIM_OK && !are_same(values, expected))
      tell_wrong(where, "other values");
    if (const Outcome next = use(simulator, setup, values);
        next.status != PMDSIM_OK || !are_same(values, expected))
      tell_wrong(where, "not usable afterwards: " + next.message);
    if (tried == 1) // what is kept from the first failure on is no loss
      bytes_before = ::mallinfo2().uordblks;
  }
  const auto grown = static_cast<long>(::mallinfo2().uordblks) - static_cast<long>(bytes_before);
  std::printf("| library  | %-14s | %7ld calls | %5d tried |", kind.c_str(), calls, tried);
  for (const auto &[status, count] : ends)
    std::printf("  %d x %d", count, status);
  std::printf(" | %ld bytes more, %ld files more\n", grown,
              static_cast<long>(open_files()) - static_cast<long>(files_before));
  if (open_files() != files_before)
    tell_wrong(kind, "files stay open");
  if (grown > 64L * tried + 65536)
    tell_wrong(kind, "memory is lost");
}

} // namespace

int main(int count, char **arguments) {
  arm = reinterpret_cast<Arm *>(dlsym(RTLD_DEFAULT, "pmdsim_fault_arm"));
  calls_of = reinterpret_cast<Calls *>(dlsym(RTLD_DEFAULT, "pmdsim_fault_calls"));
  if (count != 3 || !arm || !calls_of)
    return 2;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::string setup = arguments[1];
  const std::size_t most = std::strtoul(arguments[2], nullptr, 10);
  pmdsim_simulator *simulator = nullptr;
  Values values;
  if (pmdsim_simulator_create("cpu", &simulator) != PMDSIM_OK)
    return 3;
  if (const Outcome first = use(simulator, setup, values); first.status != PMDSIM_OK) {
    tell_wrong("first use", first.message);
    return 1;
  }
  for (const char *kind : {"malloc", "mmap", "pthread_create", "open", "fopen", "read", "stat", "opendir"})
    fail_calls(simulator, setup, kind, most);
  pmdsim_simulator_destroy(simulator);
  return wrong > 0 ? 1 : 0;
}
