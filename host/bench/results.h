#pragma once
// The results of a benchmark, in Markdown for people and in JSON for scripts (docs/commands.md, "JSON for
// scripts").

#include "host/bench/machine.h"
#include "host/bench/modes.h"
#include "host/bench/real/suite.h"
#include "host/bench/sweep.h"

#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

struct BenchReport {
  std::string command; // that was run
  BenchRequest request;
  Machine machine;
  std::vector<std::string> samples; // of each sensor: S, or "auto"
  SetupBench setup = {};
  // None for a setup of one's own.
  std::optional<SequenceRate> sequence = std::nullopt;
  std::vector<SweepRow> sweep = {};
  // Where there are any, the setup and its sweep are empty.
  std::vector<SuiteRow> suite = {};
};

nlohmann::ordered_json bench_json(const BenchReport &report);
std::string bench_markdown(const BenchReport &report);

} // namespace pmdsim
