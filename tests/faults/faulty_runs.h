#pragma once
// The program at work while one call of the system or of the device fails: what it says, how it ends, and
// what it leaves. A workload runs once undisturbed, which tells what calls there are and what its files hold,
// and then once for each call that is to fail.

#include "tests/program/program.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim::test {

// Names of files below a folder, and their bytes.
using Files = std::map<std::string, std::string>;
Files files_below(const std::filesystem::path &folder);

struct Workload {
  std::string name;
  std::vector<std::string> arguments;         // "OUT" stands for what it writes, a file or a folder
  bool is_run = true;                         // its outputs are a run's
  std::vector<std::string> again{"--resume"}; // what a further run is told that completes them
};

// Of one call that was to fail.
struct Outcome {
  std::string fault;
  bool has_failed =
      false; // not where the run had fewer calls of the kind, as its threads take turns by chance
  int exit_code = -1;
  std::string wrong{}; // empty: survived
};

class FaultyRuns {
public:
  explicit FaultyRuns(Workload workload);

  // How many calls of each kind the undisturbed run had.
  const std::map<std::string, long> &calls() const { return calls_; }

  // As tests/faults/plan.h writes it: "malloc:17". What must hold: the program ends by itself, in time, with
  // the exit code of what failed or none; it says why in a line; what it leaves is whole and equal to what
  // the undisturbed run leaves; and a run without a fault completes it.
  Outcome survive(const std::string &fault) const;

private:
  Run run(const std::filesystem::path &out, const std::map<std::string, std::string> &environment,
          const std::vector<std::string> &more = {}) const;
  std::string what_is_wrong(const std::string &fault, const Run &run, const std::filesystem::path &out) const;
  std::string wrong_files(const std::filesystem::path &out, bool must_be_all) const;

  Workload workload_;
  Files expected_;
  std::map<std::string, long> calls_;
};

// Lets the calls fail, two at a time, and prints a line for each kind: how many calls there are, how many of
// them were tried, and how these runs ended. Returns what was wrong.
std::vector<Outcome> survive_all(const FaultyRuns &runs, const std::string &workload,
                                 const std::map<std::string, std::size_t> &most_of_kind,
                                 std::size_t most_else);

} // namespace pmdsim::test
