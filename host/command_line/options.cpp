#include "host/command_line/options.h"

#include "host/capture/variants.h"
#include "host/command_line/command_examples.h"
#include "host/command_line/command_line.h"
#include "host/command_line/usage.h"
#include "host/input/calibration/calibration_sensor.h"
#include "host/input/schema/limits.h"
#include "host/manual/manual.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <vector>

namespace pmdsim {
namespace {

void check_importing(const Options &options) {
  const double pitch_m = options.pixel_pitch_m.value_or(default_pixel_pitch_m);
  if (!(pitch_m >= min_length_m && pitch_m <= max_length_m))
    throw Error(ExitCode::usage, fmt::format("--pixel-pitch-m: expected a number from {} to {}, found {}",
                                             min_length_m, max_length_m, pitch_m));
  if (!options.sensor_name.empty() && !is_sensor_name(options.sensor_name))
    throw Error(ExitCode::usage,
                "--name: expected up to 64 letters, digits, dots, dashes and underscores, the "
                "first a letter or digit, found " +
                    in_quotes(options.sensor_name));
}

// Text that is a whole number and nothing else.
std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

FrameRange frame_range_of(const std::string &text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto first = whole_number(std::string_view(text).substr(0, colon));
  const auto end = whole_number(std::string_view(text).substr(std::min(colon + 1, text.size())));
  if (!first || !end || *first >= *end)
    throw Error(ExitCode::usage,
                "--frames: expected A:B, whole numbers, A below B, found " + in_quotes(text));
  return {*first, *end};
}

// What Slurm says of an array's tasks in the environment.
std::uint32_t slurm_number(const std::string &name) {
  const char *text = std::getenv(name.c_str()); // NOLINT(concurrency-mt-unsafe): no other thread has begun
  const auto number = whole_number(text ? text : "");
  if (!number)
    throw Error(ExitCode::usage,
                fmt::format("--shard slurm: {}: expected a whole number in the environment, as in a task of "
                            "`sbatch --array`, found {}",
                            name, text ? in_quotes(text) : "nothing"));
  return *number;
}

Shard slurm_shard() {
  const std::uint32_t task = slurm_number("SLURM_ARRAY_TASK_ID"),
                      first = slurm_number("SLURM_ARRAY_TASK_MIN"),
                      count = slurm_number("SLURM_ARRAY_TASK_COUNT");
  const char *step = std::getenv("SLURM_ARRAY_TASK_STEP"); // NOLINT(concurrency-mt-unsafe): likewise
  if (step && std::string_view(step) != "1")
    throw Error(ExitCode::usage,
                fmt::format("--shard slurm: SLURM_ARRAY_TASK_STEP: expected 1, found {}", in_quotes(step)));
  if (task < first || task - first >= count)
    throw Error(ExitCode::usage, fmt::format("--shard slurm: task {} of {} from {} on: expected an array "
                                             "without gaps, as `sbatch --array=0-7`",
                                             task, count, first));
  return {task - first, count};
}

Shard shard_of(const std::string &text) {
  if (text == "slurm")
    return slurm_shard();
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto index = whole_number(std::string_view(text).substr(0, slash));
  const auto count = whole_number(std::string_view(text).substr(std::min(slash + 1, text.size())));
  if (!index || !count || *index >= *count)
    throw Error(ExitCode::usage, "--shard: expected I/N, whole numbers, I from 0 to N - 1, or slurm, found " +
                                     in_quotes(text));
  return {*index, *count};
}

SampleChoice sample_choice_of(const std::string &text) {
  if (text == "auto")
    return automatic_samples;
  const auto samples = whole_number(text);
  if (!samples || *samples < 1 || *samples > 16)
    throw Error(ExitCode::usage,
                "--samples: expected a whole number from 1 to 16, or auto, found " + in_quotes(text));
  return {.samples = *samples};
}

// A whole number, which may be written as 1e6.
std::uint32_t paths_of(const std::string &text, bool on_reference) {
  constexpr double fewest = 16.0, most = 1e9;
  if (!on_reference)
    throw Error(ExitCode::usage, "--paths: only the reference follows paths, expected --device reference "
                                 "beside it");
  const std::optional<double> paths = number_of(text);
  if (!paths || !(*paths >= fewest && *paths <= most) || *paths != std::floor(*paths))
    throw Error(ExitCode::usage, "--paths: expected a whole number from 16 to 1e9, found " + in_quotes(text));
  return static_cast<std::uint32_t>(*paths);
}

WantedChannels wanted_channels(const std::vector<std::string> &names, const std::string &command) {
  return WantedChannels(names, command == "deform" ? std::vector<std::string>{deformation_channel}
                                                   : std::vector<std::string>{});
}

// Checks the commands that compare a device with the reference.
void check_comparing(const Written &written) {
  const Options &options = written.options;
  const bool swept = options.command == "bench" && options.capture.setup.empty();
  const bool on_reference = names_the_reference(options.capture.device);
  if (swept && on_reference)
    throw Error(ExitCode::usage, "--device reference: bench without a setup compares a device with it; "
                                 "expected a device, or a setup");
  if (swept && (!written.setups.changes.empty() || written.setups.poses))
    throw Error(ExitCode::usage,
                "--set, --poses: bench without a setup has none to change; expected a setup beside them");
  if (swept && written.samples)
    throw Error(ExitCode::usage,
                "--samples: bench without a setup sweeps them itself; expected a setup beside it");
  if (options.command == "tradeoff" && on_reference)
    throw Error(ExitCode::usage, "--device reference: tradeoff compares a device with it; expected a device");
}

void take_setups(const WrittenSetups &written, Options &options) {
  options.variants = written.variants;
  if (written.setups.size() > 1 || written.variants)
    options.setups = written.setups;
  if (!written.setups.empty())
    options.capture.setup = written.setups.front();
  options.capture.changes = changes_of(written.changes);
  if (written.poses)
    options.capture.poses = poses_of(*written.poses);
  if (written.allow_outside)
    options.capture.scene_files = UriFiles::anywhere;
}

void take_reporting(const WrittenReporting &written, Options &options) {
  if (options.command == "report")
    options.report = report_request_of(written, options.capture.frames);
  if (written.when_done)
    options.report = report_request_of({}, options.capture.frames);
}

// The page is made of what the files have.
void require_formats_of_report(const std::set<Format> &formats) {
  if (!formats.contains(Format::exr) && !formats.contains(Format::h5))
    throw Error(ExitCode::usage, "--report: it is made of the frames' files, expected exr or h5 in --format");
}

Options checked(Written written, const std::string &command) {
  Options &options = written.options;
  CaptureRequest &capture = options.capture;
  options.command = command;
  take_setups(written.setups, options);
  check_importing(options);
  options.max_memory = max_memory_of(written.max_memory);
  options.correct = correct_options_of(written.correct);
  check_comparing(written);
  capture.accuracy = accuracy_of(written.accuracy, names_the_reference(capture.device));
  options.diodes = diode_request(written.diodes);
  options.mode_written = written.accuracy.mode.has_value();
  if (command == "new")
    options.fresh = new_setup_of(written.fresh);
  if (written.suite_name)
    options.suite = written.suite;
  if (written.samples)
    capture.samples = sample_choice_of(*written.samples);
  if (written.paths)
    capture.paths = paths_of(*written.paths, names_the_reference(capture.device));
  if (written.frames)
    capture.frames = frame_range_of(*written.frames);
  if (written.shard)
    capture.shard = shard_of(*written.shard);
  take_reporting(written.reporting, options);
  if (command == "merge" && capture.output_directory.empty() && options.merged.size() > 1)
    throw Error(ExitCode::usage,
                fmt::format("merge: expected -o beside {} directories", options.merged.size()));
  if (capture.output_directory.empty() && command != "merge" && command != "report")
    capture.output_directory = options.setups.size() > 1
                                   ? std::filesystem::path("out") / command
                                   : std::filesystem::path("out") / frames_folder_of(capture.setup) / command;
  if (written.formats.empty() && default_formats().contains(command))
    written.formats = default_formats().at(command);
  if (!written.channels.empty())
    capture.channels = wanted_channels(written.channels, command);
  for (const std::string &format : written.formats)
    capture.formats.insert(format_named(format));
  if (written.output_precision == output_precision_name(OutputPrecision::float64))
    capture.output_precision = OutputPrecision::float64;
  if (written.reporting.when_done)
    require_formats_of_report(capture.formats);
  return options;
}

// The command line about itself, for the build, which makes manual pages and completions of it; --help hides
// it.
void add_manual(CLI::App &app, std::vector<std::string> &what) {
  CLI::App *manual = app.add_subcommand("manual", "print manual pages and completions");
  manual->group("");
  manual->add_option("WHAT", what, "commands, man, man COMMAND, bash, zsh or fish")
      ->required()
      ->expected(1, 2);
}

std::string manual_of(const CommandTable &table, const std::vector<std::string> &what) {
  const std::string &kind = what.front();
  const CommandRow *command = what.size() > 1 ? find_command(table, what.back()) : nullptr;
  if (kind == "man" && command)
    return man_page(table, *command, PMDSIM_VERSION);
  if (what.size() > 1)
    throw Error(ExitCode::usage, "manual: expected man and a command, found " + in_quotes(what.back()));
  if (kind == "commands") {
    std::string names;
    for (const CommandRow &row : table.commands)
      names += row.name + '\n';
    return names;
  }
  if (kind == "man")
    return man_page(table, PMDSIM_VERSION);
  if (kind == "bash")
    return bash_completion(table);
  if (kind == "zsh")
    return zsh_completion(table);
  if (kind == "fish")
    return fish_completion(table);
  throw Error(ExitCode::usage, "manual: expected commands, man, bash, zsh or fish, found " + in_quotes(kind));
}

} // namespace

std::optional<Options> parse_options(int argument_count, const char *const *arguments) {
  if (argument_count <= 1) {
    std::fputs(first_steps().c_str(), stdout);
    return std::nullopt;
  }
  CLI::App app(
      "pmdsim: what a continuous-wave time-of-flight (PMD) camera measures by the light of many diodes",
      "pmdsim");
  app.set_version_flag("--version", "pmdsim " PMDSIM_VERSION);
  app.set_help_all_flag("--help-all", "print the help of every command and exit");
  app.require_subcommand(1);
  Written written;
  add_commands(app, written);
  std::vector<std::string> manual;
  add_manual(app, manual);
  const std::vector<std::string> words(arguments + std::min(argument_count, 1), arguments + argument_count);
  refuse_misread(app, words);
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError &error) {
    if (error.get_exit_code() != 0)
      throw Error(ExitCode::usage, usage_problem(app, error, words));
    app.exit(error);
    return std::nullopt;
  }
  if (!manual.empty()) {
    CommandTable table = table_of(app);
    add_suggestions(table);
    std::fputs(manual_of(table, manual).c_str(), stdout);
    return std::nullopt;
  }
  return checked(written, app.get_subcommands().front()->get_name());
}

} // namespace pmdsim
