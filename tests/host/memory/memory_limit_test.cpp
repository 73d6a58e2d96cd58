// What memory there is, as the system's files tell it, and sizes as people write them.

#include "engine/model/error.h"
#include "host/memory/byte_count.h"
#include "host/memory/machine_memory.h"
#include "host/memory/memory_limit.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

// A machine's /proc and /sys.
class Machine {
public:
  explicit Machine(std::uint64_t available_kb) {
    write("proc/meminfo", "MemTotal: 99999 kB\nMemAvailable: " + std::to_string(available_kb) + " kB\n");
  }

  void write(const std::string &file, const std::string &text) const {
    std::filesystem::create_directories((folder_.path() / file).parent_path());
    folder_.write(file, text);
  }
  AvailableMemory available() const { return available_memory(folder_.path()); }

private:
  pmdsim::test::TemporaryFolder folder_;
};

} // namespace

TEST_CASE("sizes of memory have a unit") {
  CHECK(byte_count("4GB") == 4'000'000'000u);
  CHECK(byte_count("4 GB") == 4'000'000'000u);
  CHECK(byte_count("1.5GiB") == 1'610'612'736u);
  CHECK(byte_count("500 MiB") == 524'288'000u);
  CHECK(byte_count("7B") == 7u);
  CHECK(byte_count("2kB") == 2000u);
  for (const char *wrong :
       {"", "4", "GB", "4 gb", "4G", "-4GB", "0GB", "nanGB", "infGB", "1e9TB", "4GB ", "4  GBx"})
    CHECK_FALSE(byte_count(wrong));
  CHECK(byte_text(999) == "999 B");
  CHECK(byte_text(3'254'000'000u) == "3.25 GB");
  CHECK(byte_text(999'600'000u) == "1 GB");
}

TEST_CASE("the least of what the machine and its control groups leave is available") {
  Machine machine(1000);
  CHECK(machine.available().bytes == 1'024'000);
  CHECK(machine.available().of == "the machine");

  machine.write("proc/self/cgroup", "0::/a/b\n");
  machine.write("sys/fs/cgroup/a/b/memory.max", "max\n");
  machine.write("sys/fs/cgroup/a/b/memory.current", "5000\n");
  CHECK(machine.available().bytes == 1'024'000);
  machine.write("sys/fs/cgroup/a/memory.max", "700000\n"); // of the group above
  machine.write("sys/fs/cgroup/a/memory.current", "300000\n");
  CHECK(machine.available().bytes == 400'000);
  CHECK(machine.available().of == "the control group");
  machine.write("sys/fs/cgroup/a/memory.stat",
                "anon 100\ninactive_file 50000\n"); // which the kernel can drop
  CHECK(machine.available().bytes == 450'000);
  machine.write("sys/fs/cgroup/a/memory.current", "800000\n");
  CHECK(machine.available().bytes == 0);
}

TEST_CASE("control groups of version 1 are looked at, too") {
  Machine machine(1000);
  machine.write("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/job\n0::/\n");
  machine.write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "600000\n");
  machine.write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "500000\n");
  machine.write("sys/fs/cgroup/memory/job/memory.stat", "inactive_file 1\ntotal_inactive_file 200000\n");
  CHECK(machine.available().bytes == 300'000);
}

TEST_CASE("a system that tells nothing has no limit") {
  const pmdsim::test::TemporaryFolder nothing;
  CHECK(available_memory(nothing.path()).bytes == UINT64_MAX);
}

TEST_CASE("what is asked for is beside what is taken") {
  const std::uint64_t taken = taken_memory();
  CHECK(taken > 1'000'000);
  set_max_memory(taken + 100'000'000);
  CHECK_FALSE(lack_of_memory(50'000'000));
  CHECK(memory_left() > 50'000'000);
  const auto lack = lack_of_memory(400'000'000);
  REQUIRE(lack);
  CHECK(lack->starts_with("needs 400 MB beside the "));
  CHECK(lack->find("--max-memory is ") != lack->npos);
  try {
    ask_for_memory(400'000'000, "a study", "take less");
    FAIL_CHECK("nothing was thrown");
  } catch (const Error &error) {
    CHECK(error.code() == ExitCode::out_of_memory);
    CHECK(std::string(error.what()).starts_with("out of memory: a study needs 400 MB beside the "));
    CHECK(std::string(error.what()).ends_with(": take less"));
  }
  set_max_memory(std::nullopt);
  CHECK_FALSE(lack_of_memory(1'000'000));
  CHECK(lack_of_memory(UINT64_MAX / 2));
}
