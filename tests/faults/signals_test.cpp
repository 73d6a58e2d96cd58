// Signals at random moments end a run with what is whole; pipes that nobody reads end it without a word.

#include "tests/faults/sequence.h"
#include "tests/faults/shell.h"

#include <chrono>
#include <random>
#include <thread>

using namespace pmdsim::test;

namespace {

constexpr int frames = 40;

// Sends signals at random moments to run after run, each of which goes on where the last one ended.
void check_signals(int signals, unsigned seed) {
  const Sequence sequence(frames);
  const std::string out = sequence.work / "out", whole = sequence.work / "whole";
  const auto start = std::chrono::steady_clock::now();
  REQUIRE(run_pmdsim(sequence.arguments(whole)).exit_code == 0);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  constexpr std::array kinds{SIGINT, SIGTERM, SIGHUP};
  int interrupted = 0, at_start = 0;
  for (int i = 0; i < signals; ++i) {
    const int kind = kinds[random() % kinds.size()];
    INFO("signal " << kind << ", number " << i << " of seed " << seed);
    const bool begins = i % 8 == 0;
    if (begins)
      std::filesystem::remove_all(out);
    const std::size_t frames_before = check_whole(out);
    RunningPmdsim program(
        sequence.arguments(out, begins ? std::vector<std::string>{} : std::vector<std::string>{"--resume"}));
    std::this_thread::sleep_for(time * share(random));
    program.send(kind);
    const Run run = program.wait();
    INFO(run.errors);
    // Until the program has its handlers, in its first milliseconds, a signal ends it as any other.
    if (run.exit_code == 128 + kind && kind != SIGINT && check_whole(out) == frames_before)
      ++at_start;
    else
      CHECK((run.exit_code == 130 || run.exit_code == 0));
    interrupted += run.exit_code == 130 ? 1 : 0;
    check_whole(out);
  }
  const Run last = run_pmdsim(sequence.arguments(out, {"--resume"}));
  CHECK(last.exit_code == 0);
  CHECK(check_whole(out) == frames);
  Files expected = files_below(whole), found = files_below(out);
  for (Files *files : {&expected, &found})
    std::erase_if(*files, [](const auto &file) { return file.first.ends_with(".json"); });
  CHECK(found == expected);
  fmt::print("{} signals, {} of them interrupted a run, {} came before its first step\n", signals,
             interrupted, at_start);
}

std::string quoted(const std::vector<std::string> &arguments) {
  std::string text = "'" PMDSIM_PROGRAM "'";
  for (const std::string &argument : arguments)
    text += " '" + argument + "'";
  return text;
}

} // namespace

TEST_CASE("Signals at random moments leave whole frames alone") { check_signals(12, 1); }
TEST_CASE("Signals at random moments leave whole frames alone, many of them", "[long]") {
  check_signals(400, 2);
}

TEST_CASE("A pipe that nobody reads ends the program without a word, and after its work") {
  const Sequence sequence(3);
  const std::string out = sequence.work / "out";
  const ShellRun run =
      run_in_shell("(" + quoted(sequence.arguments(out)) + "; echo $? >&3) 3>&1 2>&1 >/dev/null | cat; " +
                   "(" + quoted(sequence.arguments(out)) + "; echo $? >&3) 3>'" + out + ".code' 2>&1 | true");
  CHECK(run.output == "0\n");
  CHECK(run_in_shell("cat '" + out + ".code'").output == "141\n");
  CHECK(check_whole(out) == 3);
}

TEST_CASE("Streams that are closed or full are told of, where that can be") {
  const Sequence sequence(2);
  const std::string render = quoted(sequence.arguments(sequence.work / "out"));
  CHECK(run_in_shell(render + " >/dev/full 2>&1").exit_code == 7);
  CHECK(check_whole(sequence.work / "out") == 2);
  CHECK(run_in_shell(quoted({"--help"}) + " >/dev/full 2>/dev/null").exit_code == 7);
  CHECK(run_in_shell(render + " >&- 2>/dev/null").exit_code == 7);
  CHECK(run_in_shell(render + " 2>/dev/full >/dev/null").exit_code == 0);
  CHECK(run_in_shell(render + " 2>&- >/dev/null").exit_code == 0);
  CHECK(run_in_shell(quoted({"check", "/nowhere.json"}) + " 2>/dev/full").exit_code == 3);
}

TEST_CASE("No file takes the number of a stream that is closed") {
  const Sequence sequence(2);
  const std::vector<std::string> wraps{"--set", "sensors/0/modulation_hz=[90e6]"}; // of which a warning tells
  for (const auto &[streams, exit_code] : {std::pair(" >&- 2>/dev/null", 7), {" 2>&- >/dev/null", 0}}) {
    INFO(streams);
    const std::string out = sequence.work / fmt::format("closed{}", exit_code);
    CHECK(run_in_shell(quoted(sequence.arguments(out, wraps)) + streams).exit_code == exit_code);
    std::vector<std::string> again = wraps;
    again.emplace_back("--resume"); // reads run.json
    CHECK(run_pmdsim(sequence.arguments(out, again)).exit_code == 0);
    CHECK(check_whole(out) == 2);
  }
}

TEST_CASE("A second signal ends what has no safe point", "[no_thread_sanitizer]") {
  const Sequence sequence(1);
  const std::string fifo = "'" + (sequence.work / "fifo") + "'";
  // The pipe is nearly full, and nobody reads it: the page waits to be written.
  const ShellRun run = run_in_shell(
      "mkfifo " + fifo + "; sleep 60 <" + fifo + " & reader=$!; head -c 60000 /dev/zero >" + fifo + "; " +
      quoted({"explain", "--markdown"}) + " >" + fifo + " & writer=$!; " +
      "sleep 1; kill -TERM $writer; kill -TERM $writer; sleep 3; kill -0 $writer && echo waits; " +
      "kill -TERM $writer; wait $writer; echo $?; kill $reader");
  CHECK(run.output == "waits\n143\n");
}
