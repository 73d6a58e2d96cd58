// What the program says of itself: first steps, and the examples of every command's help, which work.

#include "tests/program/refusal.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

std::vector<std::string> help_lines(const std::string &text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

std::vector<std::string> commands() { return help_lines(run_pmdsim({"manual", "commands"}).output); }

// The command line that begins a row of a table, up to two spaces, word by word and without the program's
// name.
std::vector<std::string> arguments_of(const std::string &row) {
  const std::string line = row.substr(2, row.find("  ", 2) - 2);
  std::vector<std::string> words;
  std::istringstream in(line);
  for (std::string word; in >> word;)
    words.push_back(word);
  REQUIRE(words.front() == "pmdsim");
  words.erase(words.begin());
  return words;
}

// Of the section "Examples:" of a command's help.
std::vector<std::vector<std::string>> examples_of(const std::string &command) {
  const std::vector<std::string> help = help_lines(run_pmdsim({command, "--help"}).output);
  std::vector<std::vector<std::string>> examples;
  for (auto line = std::ranges::find(help, "Examples:"); line != help.end() && ++line != help.end();) {
    if (!line->starts_with("  pmdsim "))
      break;
    examples.push_back(arguments_of(*line));
  }
  return examples;
}

// A folder in which `pmdsim new room` has been run, with what examples name beside it.
void furnish(const Workspace &work) {
  work.write("camera.yml", opencv_calibration());
  work.write("camera_info.yaml", "width: 12\nheight: 8\ndistortion_model: ''\nd: []\n"
                                 "k: [40.0, 0.0, 5.5, 0.0, 40.0, 3.5, 0.0, 0.0, 1.0]\n");
  work.write("study.jsonl", R"({"sensors/0/taps": 4})");
  std::filesystem::create_directory_symlink(PMDSIM_SCENES, work.path() / "scenes");
}

} // namespace

TEST_CASE("without arguments the program says what to do first, and it works", "[smoke]") {
  const Run run = run_pmdsim({});
  CHECK(run.exit_code == 0);
  CHECK(run.errors.empty());
  const Workspace work;
  int steps = 0;
  for (const std::string &line : help_lines(run.output))
    if (line.starts_with("  pmdsim ")) {
      INFO(line);
      const Run step = run_pmdsim(arguments_of(line), {.directory = work.path()});
      INFO(step.errors);
      CHECK(step.exit_code == 0);
      ++steps;
    }
  CHECK(steps == 5);
  CHECK(std::filesystem::is_regular_file(work / "room/out/camera_0000.exr"));
}

TEST_CASE("every command has examples of its own") {
  for (const std::string &command : commands()) {
    INFO(command);
    const auto examples = examples_of(command);
    CHECK(examples.size() >= 2);
    for (const auto &example : examples)
      CHECK(example.front() == command);
  }
}

// Those that take long are parsed by tests/host/commands/options_test.cpp.
TEST_CASE("the examples of every command that is quick work") {
  const Workspace work;
  furnish(work);
  for (const std::string &command : commands())
    for (const auto &example : examples_of(command)) {
      const bool takes_long = command == "bench" || command == "tradeoff" || command == "noise";
      const bool needs_parts = std::ranges::find(example, "part0") != example.end();
      if (takes_long || needs_parts)
        continue;
      INFO(command << " ... " << example.back());
      const Run run = run_pmdsim(example, {.directory = work.path()});
      INFO(run.errors);
      CHECK(run.exit_code == 0);
    }
}

TEST_CASE("every command knows --json, and prints one object") {
  for (const std::string &command : commands())
    CHECK(run_pmdsim({command, "--help"}).output.find("--json") != std::string::npos);
  const Workspace work;
  furnish(work);
  for (const std::vector<std::string> &arguments : {std::vector<std::string>{"new", "room"},
                                                    {"check", "room/setup.json"},
                                                    {"explain", "taps"},
                                                    {"explain"},
                                                    {"schema"},
                                                    {"devices"},
                                                    {"import-calibration", "camera.yml"}}) {
    std::vector<std::string> with_json = arguments;
    with_json.emplace_back("--json");
    const Run run = run_pmdsim(with_json, {.directory = work.path()});
    INFO(run.errors);
    CHECK(run.exit_code == 0);
    CHECK(json::parse(run.output).is_object());
  }
  // What is wrong is told in the same way with and without.
  check_refusal(run_pmdsim({"check", "none.json", "--json"}), 3, {"none.json"});
}
