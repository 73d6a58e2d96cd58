// The command line, parsed.

#include "engine/model/error.h"
#include "host/command_line/command_examples.h"
#include "host/command_line/options.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

using namespace pmdsim;

namespace {

Options parsed(std::vector<const char *> arguments) {
  arguments.insert(arguments.begin(), "pmdsim");
  return parse_options(static_cast<int>(arguments.size()), arguments.data()).value();
}

Options rendered(const std::vector<const char *> &more) {
  std::vector<const char *> arguments{"render", "a.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return parsed(arguments);
}

std::string refusal(const std::vector<const char *> &more) {
  try {
    rendered(more);
  } catch (const Error &error) {
    CHECK(error.code() == ExitCode::usage);
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.what();
  }
  return "none";
}

} // namespace

TEST_CASE("the examples that help shows are command lines") {
  for (const CommandExample &example : command_examples()) {
    INFO(example.line);
    std::vector<std::string> words;
    std::istringstream in{std::string(example.line)};
    for (std::string word; in >> word;)
      words.push_back(word);
    std::vector<const char *> arguments;
    for (const std::string &word : words)
      arguments.push_back(word.c_str());
    REQUIRE(words.front() == "pmdsim");
    const Options options = parse_options(static_cast<int>(arguments.size()), arguments.data()).value();
    CHECK(options.command == example.command);
    CHECK(examples_text(example.command).find(example.about) != std::string::npos);
  }
}

TEST_CASE("without a word about accuracy the mode is exact") {
  const Options options = rendered({});
  CHECK(options.capture.accuracy.mode == Mode::exact);
  CHECK_FALSE(options.capture.accuracy.precision);
  CHECK_FALSE(options.mode_written);
  CHECK_FALSE(options.capture.samples);
}

TEST_CASE("an error that is bounded means the cheapest way, unless a mode is written") {
  const Accuracy by_length = rendered({"--max-error", "0.1mm"}).capture.accuracy;
  CHECK(by_length.mode == Mode::automatic);
  CHECK(by_length.max_error_m == 1e-4);
  CHECK(std::isinf(by_length.max_amplitude_error));
  const Accuracy by_amplitude = rendered({"--max-amplitude-error", "1e-3"}).capture.accuracy;
  CHECK(by_amplitude.mode == Mode::automatic);
  CHECK(by_amplitude.max_amplitude_error == 1e-3);
  CHECK(by_amplitude.max_error_m == default_max_error_m);
  const Options reduced = rendered({"--max-error", "5um", "--mode", "reduced", "--precision", "fp64"});
  CHECK(reduced.capture.accuracy.mode == Mode::reduced);
  CHECK(reduced.capture.accuracy.precision == Precision::fp64);
  CHECK(reduced.mode_written);
}

TEST_CASE("samples are a number or auto") {
  CHECK(rendered({"--samples", "16"}).capture.samples->samples == 16);
  CHECK_FALSE(rendered({"--samples", "16"}).capture.samples->adaptive);
  CHECK(rendered({"--samples", "auto"}).capture.samples->samples == 4);
  CHECK(rendered({"--samples", "auto"}).capture.samples->adaptive);
  for (const char *text : {"0", "17", "all", "4x", "-1"})
    CHECK(refusal({"--samples", text}) ==
          std::string("--samples: expected a whole number from 1 to 16, or auto, found \"") + text + "\"");
}

TEST_CASE("what cannot be promised is refused in one line") {
  CHECK(refusal({"--max-error", "5"})
            .starts_with("--max-error: expected a length from 1e-09 m to 1000000 m with its unit"));
  for (const char *text : {"0", "-1e-3", "1.5", "1e-3x", "nan", ""})
    CHECK(refusal({"--max-amplitude-error", text})
              .starts_with("--max-amplitude-error: expected a number above 0"));
  CHECK(refusal({"--mode", "exact", "--max-error", "5um"}).starts_with("--max-error: mode exact "));
  CHECK(refusal({"--mode", "exact", "--max-amplitude-error", "1e-3"})
            .starts_with("--max-amplitude-error: mode exact "));
  CHECK(refusal({"--precision", "fp16"}).find("--precision") != std::string::npos);
}

TEST_CASE("the reference is exact, in double") {
  CHECK(rendered({"--device", "reference", "--mode", "exact", "--precision", "fp64"}).capture.accuracy.mode ==
        Mode::exact);
  const std::string exact = "--device reference: expected mode exact";
  CHECK(refusal({"--device", "reference", "--mode", "auto"}).starts_with(exact));
  CHECK(refusal({"--device", "Reference", "--mode", "reduced"}).starts_with(exact));
  CHECK(refusal({"--device", "reference", "--max-error", "5um"}).starts_with(exact));
  CHECK(refusal({"--device", "reference", "--precision", "fp32"})
            .starts_with("--device reference: expected precision fp64"));
  CHECK_THROWS_WITH(parsed({"tradeoff", "a.json", "--device", "reference"}),
                    Catch::StartsWith("--device reference: tradeoff "));
}

TEST_CASE("only the reference follows paths") {
  CHECK(rendered({}).capture.paths == 0);
  CHECK(rendered({"--device", "reference", "--paths", "16"}).capture.paths == 16);
  CHECK(rendered({"--device", "Reference", "--paths", "1e9"}).capture.paths == 1'000'000'000);
  CHECK(parsed({"deform", "a.json", "--device", "reference", "--paths", "100"}).capture.paths == 100);
  for (const char *text : {"15", "1.1e9", "20.5", "many", "", "nan", "-20"})
    CHECK(refusal({"--device", "reference", "--paths", text}) ==
          std::string("--paths: expected a whole number from 16 to 1e9, found \"") + text + "\"");
  CHECK(refusal({"--paths", "100"}).starts_with("--paths: only the reference follows paths"));
  CHECK(refusal({"--device", "0", "--paths", "100"}).starts_with("--paths: only the reference"));
  CHECK_THROWS_AS(parsed({"bench", "a.json", "--device", "reference", "--paths", "100"}), Error);
}

TEST_CASE("tradeoff takes a setup, samples, a device and a place for its files") {
  const Options options = parsed({"tradeoff", "scenes/a.json", "--samples", "2", "--device", "1"});
  CHECK(options.command == "tradeoff");
  CHECK(options.capture.samples->samples == 2);
  CHECK(options.capture.output_directory == "out/a/tradeoff");
  CHECK_THROWS_AS(parsed({"tradeoff", "a.json", "--mode", "exact"}), Error);
}

TEST_CASE("a run goes on and is divided where that is asked for") {
  const CaptureRequest plain = rendered({}).capture;
  CHECK_FALSE(plain.resume);
  CHECK(plain.shard.count == 1);
  const CaptureRequest asked = rendered({"--resume", "--shard", "2/5", "--frames", "3:9"}).capture;
  CHECK(asked.resume);
  CHECK(asked.shard.index == 2);
  CHECK(asked.shard.count == 5);
  CHECK(asked.frames->first == 3);
  CHECK(refusal({"--shard", "5/5"}) ==
        "--shard: expected I/N, whole numbers, I from 0 to N - 1, or slurm, found \"5/5\"");
}

TEST_CASE("directories are merged into another, or one's manifest is made again") {
  const Options one = parsed({"merge", "a"});
  CHECK(one.merged == std::vector<std::filesystem::path>{"a"});
  CHECK(one.capture.output_directory.empty());
  const Options several = parsed({"merge", "a", "b", "-o", "c", "--frames", "1:4"});
  CHECK(several.merged.size() == 2);
  CHECK(several.capture.output_directory == "c");
  CHECK(several.capture.frames->end == 4);
  CHECK_THROWS_WITH(parsed({"merge", "a", "b"}), "merge: expected -o beside 2 directories");
}

TEST_CASE("Arguments of any length and any bytes are refused in a line of UTF-8") {
  const std::string long_word(200'000,
                              'a'); // over which a regular expression would recurse until the stack ends
  CHECK(refusal({"--mode", long_word.c_str()})
            .starts_with("--mode: expected exact, reduced, auto, found \"aaa"));
  CHECK(refusal({"--format", long_word.c_str()}).starts_with("--format: expected "));
  CHECK(refusal({"--mode", "a not in {b}"}).find("found \"a not in {b}\"") != std::string::npos);
  CHECK(refusal({"--a\x15\xff"}).starts_with("render has no option --a??"));
  CHECK(refusal({"-mode\n=auto"}).starts_with("render has no option -mode?, did you mean --mode? (see "));
  const auto bench = [&](const char *value) { parsed({"bench", "--suite", "real", "--triangles", value}); };
  CHECK_THROWS_WITH(bench("many"),
                    "--triangles: Value many not in range 1000 to 10000000 (see pmdsim bench --help)");
  CHECK_THROWS_AS(bench(long_word.c_str()), Error);
}
