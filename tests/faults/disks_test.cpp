// Disks that are full, folders that may not be written to or go away, sizes that are not allowed, streams
// that nobody reads: the program says so in a line, and leaves what is whole.

#include "tests/faults/plan.h"
#include "tests/faults/sequence.h"
#include "tests/faults/shell.h"

#include <cerrno>
#include <sys/mount.h>
#include <unistd.h>

using namespace pmdsim::test;

namespace {

namespace fs = std::filesystem;

// A file system of its own in memory, of so many bytes. Only root may mount one.
class SmallDisk {
public:
  SmallDisk(const fs::path &at, const std::string &options) : at_(at) {
    fs::create_directories(at);
    is_there_ = ::mount("tmpfs", at.c_str(), "tmpfs", 0, options.c_str()) == 0;
  }
  ~SmallDisk() {
    if (is_there_)
      ::umount2(at_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk &) = delete;
  SmallDisk &operator=(const SmallDisk &) = delete;
  bool is_there() const { return is_there_; }

private:
  fs::path at_;
  bool is_there_;
};

} // namespace

TEST_CASE("A disk that becomes full ends a run with the frames that fit") {
  const Sequence sequence(40);
  const auto [options, why] = GENERATE(table<std::string, std::string>(
      {{"size=200k", "No space left on device"}, {"size=64m,nr_inodes=60", "No space left on device"}}));
  const SmallDisk disk(sequence.work.path() / "disk", options);
  if (::getuid() != 0) {
    WARN("only root can mount a small disk");
    return;
  }
  REQUIRE(disk.is_there());
  const fs::path out = sequence.work.path() / "disk/out";
  const Run run = run_pmdsim(sequence.arguments(out.string()));
  INFO(run.errors);
  CHECK(run.exit_code == 7);
  CHECK(run.errors.find(why) != std::string::npos);
  CHECK(check_whole(out) < 40);
}

TEST_CASE("A quota that is used up ends a run with the frames that fit", "[no_sanitizer]") {
  const Sequence sequence(40);
  const fs::path out = sequence.work.path() / "out";
  RunOptions options;
  options.environment = {{"PMDSIM_VALIDATE", "0"},
                         {"LD_PRELOAD", PMDSIM_FAILING_CALLS},
                         {pmdsim::faults::plan_variable, fmt::format("fallocate:100+:{}", EDQUOT)}};
  const Run run = run_pmdsim(sequence.arguments(out.string()), options);
  INFO(run.errors);
  CHECK(run.exit_code == 7);
  CHECK(run.errors.find("Disk quota exceeded") != std::string::npos);
  const std::size_t done = check_whole(out);
  CHECK((done > 0 && done < 40));
}

// The shell lowers the limit, so that the test itself keeps its own.
TEST_CASE("A limit of a file's size is an error, not the end") {
  const Sequence sequence(4);
  std::string command = "ulimit -f 1; exec '" PMDSIM_PROGRAM "'";
  for (const std::string &argument : sequence.arguments(sequence.work / "out"))
    command += " '" + argument + "'";
  const ShellRun run = run_in_shell("(" + command + ") 2>&1");
  INFO(run.output);
  CHECK(run.exit_code == 7);
  CHECK(run.output.find("File too large") != std::string::npos);
  CHECK(check_whole(sequence.work / "out") == 0);
}

TEST_CASE("A folder that is read-only, or goes away meanwhile, is told of") {
  const Sequence sequence(400);
  SECTION("read-only") {
    const SmallDisk disk(sequence.work.path() / "disk", "size=1m");
    if (::getuid() != 0) {
      WARN("only root can mount a small disk");
      return;
    }
    REQUIRE(disk.is_there());
    REQUIRE(::mount(nullptr, (sequence.work / "disk").c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) ==
            0);
    const Run run = run_pmdsim(sequence.arguments(sequence.work / "disk/out"));
    INFO(run.errors);
    CHECK(run.exit_code == 7);
    CHECK(run.errors.find("Read-only file system") != std::string::npos);
  }
  SECTION("it goes away") {
    const std::string out = sequence.work / "out";
    RunningPmdsim program(sequence.arguments(out));
    wait_for(out + "/0000.record.json");
    std::filesystem::rename(out, out + "_before");
    for (std::error_code again; std::filesystem::exists(out + "_before");) // while files still come
      std::filesystem::remove_all(out + "_before", again);
    const Run run = program.wait();
    INFO(run.errors);
    CHECK(run.exit_code == 7);
    CHECK(run.errors.find("No such file or directory") != std::string::npos);
  }
}
