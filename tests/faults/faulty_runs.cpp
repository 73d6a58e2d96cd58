#include "tests/faults/faulty_runs.h"

#include "tests/faults/chosen_calls.h"
#include "tests/faults/plan.h"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

namespace pmdsim::test {
namespace {

namespace fs = std::filesystem;

std::map<std::string, long> counts_in(const fs::path &file) {
  std::map<std::string, long> counts;
  std::ifstream in(file);
  std::string kind;
  for (long count = 0; in >> kind >> count;)
    counts[kind] += count;
  return counts;
}

// Exit codes that tell the truth about a call of the kind that failed.
std::set<int> codes_of(const std::string &kind) {
  static const std::set<int> memory{5}, device{4, 5, 6};
  static const std::map<std::string, std::set<int>> codes{
      {"malloc", memory}, {"mmap", memory},     {"pthread_create", memory},
      {"open", {3, 7}},   {"fopen", {3, 5, 7}}, {"read", {3, 7}},
      {"write", {7}},     {"fsync", {7}},       {"close", {3, 7}},
      {"rename", {7}},    {"link", {7}},        {"unlink", {7}},
      {"mkdir", {7}},     {"stat", {3, 7}},     {"fcntl", {7}},
      {"fallocate", {7}}, {"opendir", {3, 7}}};
  return kind.starts_with("vk") ? device : codes.at(kind);
}

// A name of what holds times, or depends on who has made it.
bool may_differ(const std::string &name) {
  return name.ends_with(".record.json") || name.ends_with("manifest.json") || name.ends_with("run.json") ||
         name.ends_with(".html") || name.ends_with("study.json");
}

bool is_line_of_error(const std::string &errors) {
  const auto start = errors.rfind("pmdsim: error: ");
  return start != errors.npos && errors.ends_with('\n') &&
         std::count(errors.begin() + static_cast<std::ptrdiff_t>(start), errors.end(), '\n') == 1;
}

// Frames of which there is a record, and files of frames of which there is none.
std::string wrong_run(const Files &files) {
  std::set<std::string> named;
  for (const auto &[name, bytes] : files)
    if (name.ends_with(".record.json")) {
      const nlohmann::json record = nlohmann::json::parse(bytes);
      for (const auto &sensor : record.at("sensors"))
        for (const auto &output : sensor.at("manifest").at("outputs"))
          named.insert((fs::path(name).parent_path() / output.get<std::string>()).string());
    }
  for (const std::string &name : named)
    if (!files.contains(name))
      return "a record names " + name + ", which is not there";
  for (const auto &[name, bytes] : files)
    if (!may_differ(name) && !named.contains(name) && !name.ends_with(".sheet.png") &&
        !name.ends_with(".apng"))
      return "no record names " + name;
  return {};
}

} // namespace

Files files_below(const fs::path &folder) {
  Files files;
  if (fs::is_regular_file(folder))
    files["."] = {std::istreambuf_iterator<char>(std::ifstream(folder, std::ios::binary).rdbuf()), {}};
  if (!fs::is_directory(folder))
    return files;
  for (const auto &entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) {
      std::ifstream in(entry.path(), std::ios::binary);
      files[fs::relative(entry.path(), folder).string()] = {std::istreambuf_iterator<char>(in), {}};
    }
  return files;
}

FaultyRuns::FaultyRuns(Workload workload) : workload_(std::move(workload)) {
  const TemporaryFolder folder;
  run(folder.path() / "first", {}); // which fills the shader cache
  const fs::path counts = folder.path() / "counts";
  const Run undisturbed = run(folder.path() / "out", {{faults::counts_variable, counts.string()}});
  if (undisturbed.exit_code != 0)
    throw std::runtime_error(workload_.name + ": " + undisturbed.errors);
  expected_ = files_below(folder.path() / "out");
  calls_ = counts_in(counts);
  const bool writes = !expected_.empty();
  if (calls_["malloc"] == 0 || (writes && calls_["fsync"] == 0))
    throw std::runtime_error(workload_.name + ": the failing calls were not loaded, or call nothing");
}

Run FaultyRuns::run(const fs::path &out, const std::map<std::string, std::string> &environment,
                    const std::vector<std::string> &more) const {
  std::vector<std::string> arguments = workload_.arguments;
  std::ranges::replace(arguments, std::string("OUT"), out.string());
  arguments.insert(arguments.end(), more.begin(), more.end());
  RunOptions options{.environment = environment};
  options.environment["PMDSIM_VALIDATE"] = "0"; // the validation layer takes no failure well
  if (!environment.empty()) {
    options.environment["LD_PRELOAD"] = PMDSIM_FAILING_CALLS;
    options.environment["VK_LAYER_PATH"] = PMDSIM_FAILING_LAYER_FOLDER;
    options.environment["VK_INSTANCE_LAYERS"] = "VK_LAYER_PMDSIM_faults";
  }
  return run_pmdsim(arguments, options);
}

Outcome FaultyRuns::survive(const std::string &fault) const {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out", counts = folder.path() / "counts";
  const Run faulty = run(out, {{faults::plan_variable, fault}, {faults::counts_variable, counts.string()}});
  const auto told = counts_in(counts);
  const bool has_failed = told.empty() || told.contains("failed"); // a process that was killed tells nothing
  return {fault, has_failed, faulty.exit_code, what_is_wrong(fault, faulty, out)};
}

std::string FaultyRuns::what_is_wrong(const std::string &fault, const Run &faulty,
                                      const fs::path &out) const {
  const std::string kind = fault.substr(0, fault.find(':'));
  const bool is_done = faulty.exit_code == 0;
  const std::string ended = fmt::format("exit code {}, {}", faulty.exit_code, faulty.errors);
  if (!is_done && !codes_of(kind).contains(faulty.exit_code))
    return ended;
  const bool may_be_mute = kind == "write"; // that was the message itself
  if (!is_done && !may_be_mute && !is_line_of_error(faulty.errors))
    return "no line that tells why: " + ended;
  if (const std::string wrong = wrong_files(out, is_done); !wrong.empty())
    return fmt::format("{} ({})", wrong, ended);
  if (is_done)
    return {};
  // What it left must not be in the way of the next.
  const Run next = run(out, {}, workload_.again);
  if (next.exit_code != 0)
    return fmt::format("the next run: exit code {}, {}", next.exit_code, next.errors);
  const std::string wrong = wrong_files(out, true);
  return wrong.empty() ? wrong : "after the next run: " + wrong;
}

std::string FaultyRuns::wrong_files(const fs::path &out, bool must_be_all) const {
  const Files files = files_below(out);
  for (const auto &[name, bytes] : files) {
    if (name.ends_with(".partial"))
      return name + " is left";
    if (!expected_.contains(name))
      return name + " is not to be there";
    if (!may_differ(name) && bytes != expected_.at(name))
      return name + " holds other bytes";
  }
  if (must_be_all && files.size() != expected_.size())
    return fmt::format("{} files, expected {}", files.size(), expected_.size());
  return workload_.is_run ? wrong_run(files) : std::string();
}

std::vector<Outcome> survive_all(const FaultyRuns &runs, const std::string &workload,
                                 const std::map<std::string, std::size_t> &most_of_kind,
                                 std::size_t most_else) {
  constexpr std::size_t at_once = 2;
  std::vector<std::string> planned;
  for (const auto &[kind, calls] : runs.calls())
    for (const long call :
         faults::chosen_calls(calls, most_of_kind.contains(kind) ? most_of_kind.at(kind) : most_else, 1))
      planned.push_back(fmt::format("{}:{}", kind, call));
  std::vector<Outcome> outcomes(planned.size());
  std::atomic<std::size_t> next{0};
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < at_once; ++i)
    threads.emplace_back([&] {
      for (std::size_t at = next++; at < planned.size(); at = next++)
        outcomes[at] = runs.survive(planned[at]);
    });
  threads.clear();

  std::vector<Outcome> wrong;
  for (const auto &[kind, calls] : runs.calls()) {
    std::map<int, int> ends;
    int tried = 0;
    for (const Outcome &outcome : outcomes)
      if (outcome.fault.starts_with(kind + ":") && outcome.has_failed) {
        ++tried;
        ++ends[outcome.exit_code];
      }
    std::string text;
    for (const auto &[code, count] : ends)
      text += fmt::format("  {} x {}", count, code);
    if (tried > 0)
      fmt::print("| {:<8} | {:<40} | {:>7} | {:>5} |{} |\n", workload, kind, calls, tried, text);
  }
  for (const Outcome &outcome : outcomes)
    if (!outcome.wrong.empty())
      wrong.push_back(outcome);
  return wrong;
}

} // namespace pmdsim::test
