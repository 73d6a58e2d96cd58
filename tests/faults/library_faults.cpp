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
#include <optional>
#include <string>
#include <utility>
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

class FailingCalls {
public:
  FailingCalls(pmdsim_simulator *simulator, std::string setup, std::string kind)
      : simulator_(simulator), setup_(std::move(setup)), kind_(std::move(kind)) {
    arm(kind_.c_str(), -1);
    use(simulator_, setup_, expected_);
    calls_ = calls_of(kind_.c_str());
    arm("", 0);
    values_ = expected_; // which are not to be allocated while calls fail
  }

  void fail(std::size_t most) {
    const std::size_t files_before = open_files();
    for (const long call : pmdsim::faults::chosen_calls(calls_, most, 1))
      fail_call(call);
    std::printf("| library  | %-14s | %7ld calls | %5d tried |", kind_.c_str(), calls_, tried_);
    for (const auto &[status, count] : ends_)
      std::printf("  %d x %d", count, status);
    std::printf("\n");
    if (open_files() != files_before)
      tell_wrong(kind_, "files stay open");
  }

private:
  // What a failure leaves may be kept for the next ones, as the driver's caches are, which grow for a while;
  // what each one leaves, however often, is lost.
  void fail_call(long call) {
    constexpr long few_bytes = 512;
    constexpr int most_again = 30;
    const std::optional<long> kept = kept_bytes(call);
    if (!kept)
      return;
    ++tried_;
    long again = *kept;
    for (int i = 0; i < most_again && again > few_bytes; ++i)
      again = kept_bytes(call).value_or(0);
    if (again > few_bytes)
      tell_wrong(kind_ + ":" + std::to_string(call), "loses " + std::to_string(again) + " bytes");
  }

  // What is allocated after the call has failed, and the library has been used again, beyond what was before.
  // Nothing where there was no such call.
  std::optional<long> kept_bytes(long call) {
    const std::string where = kind_ + ":" + std::to_string(call);
    const std::size_t before = ::mallinfo2().uordblks;
    {
      arm(kind_.c_str(), call);
      const auto [status, message] = use(simulator_, setup_, values_);
      if (arm("", 0) == 0)
        return std::nullopt;
      ++ends_[status];
      if (!is_right(kind_, status))
        tell_wrong(where, "status " + std::to_string(status) + ", " + message);
      else if (status != PMDSIM_OK && (message.empty() || message.find('\n') != message.npos))
        tell_wrong(where, "no line that tells why: " + message);
      else if (status == PMDSIM_OK && !are_same(values_, expected_))
        tell_wrong(where, "other values");
      if (const Outcome next = use(simulator_, setup_, values_);
          next.status != PMDSIM_OK || !are_same(values_, expected_))
        tell_wrong(where, "not usable afterwards: " + next.message);
    }
    return static_cast<long>(::mallinfo2().uordblks) - static_cast<long>(before);
  }

  pmdsim_simulator *simulator_;
  std::string setup_, kind_;
  Values expected_, values_;
  long calls_ = 0;
  std::map<int, int> ends_;
  int tried_ = 0;
};

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
    FailingCalls(simulator, setup, kind).fail(most);
  pmdsim_simulator_destroy(simulator);
  return wrong > 0 ? 1 : 0;
}
