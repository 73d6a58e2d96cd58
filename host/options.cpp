#include "host/options.h"

#include "host/accuracy_options.h"
#include "host/input/calibration/calibration_sensor.h"
#include "host/input/schema/limits.h"
#include "host/manual/manual.h"
#include "host/setup_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <vector>

namespace pmdsim {
namespace {

const std::map<std::string, Format> format_names{{"exr", Format::exr}, {"npz", Format::npz},
                                                 {"h5", Format::h5},   {"npy", Format::npy},
                                                 {"png", Format::png}, {"csv", Format::csv}};
// The formats of the commands that write frames.
const std::map<std::string, std::vector<std::string>> default_formats{{"render", {"exr", "png"}},
                                                                      {"deform", {"exr", "png", "csv"}}};

// The command line before it is checked, and those parts of it that are only taken over.
struct Written {
  Options options;
  WrittenAccuracy accuracy;
  WrittenSetups setups;
  std::optional<std::string> samples, frames, shard, paths, suite_name;
  SuiteOptions suite;
  std::vector<std::string> formats, channels;
};

void add_setup(CLI::App &command, Written &written, Setups setups = Setups::one) {
  add_setups(command, written.setups, setups);
}

void add_samples(CLI::App &command, Written &written) {
  command.add_option("--samples", written.samples,
                     "S: S x S samples a pixel, 1 to 16, or `auto`, instead of the setup's");
}

void add_measuring(CLI::App &command, Written &written) {
  add_samples(command, written);
  command.add_option(
      "--device", written.options.capture.device,
      "part of a device's name, its index (see `pmdsim devices`), `cpu`, `gpu`, or `reference`");
  add_accuracy(command, written.accuracy);
  command.add_flag("--no-wide-vectors")
      ->description(
          "lavapipe: vectors of no more than 256 bits, whatever LP_NATIVE_VECTOR_WIDTH says; always so");
}

void add_output(CLI::App &command, Written &written) {
  command.add_option(
      "-o,--output", written.options.capture.output_directory,
      fmt::format("output directory [out/SETUP/{}, SETUP without its ending]", command.get_name()));
}

void add_frames(CLI::App &command, Written &written) {
  command.add_option("--frames", written.frames,
                     "A:B, frames A to B - 1 of the setup's, the first is 0 [all]");
}

void add_writing(CLI::App &command, Written &written) {
  add_output(command, written);
  command
      .add_option("--format", written.formats,
                  fmt::format("what to write: exr, npz, h5, npy, png, csv, separated by commas [{}]",
                              fmt::join(default_formats.at(command.get_name()), ",")))
      ->delimiter(',')
      ->check(CLI::IsMember({"exr", "npz", "h5", "npy", "png", "csv"}));
  command
      .add_option(
          "--channels", written.channels,
          "only these, by names separated by commas, e.g. distance_m,lit; without the numbers of taps, "
          "with or without the prefix of a frequency. What no other needs is not computed [all]")
      ->delimiter(',');
  add_frames(command, written);
  command.add_option("--shard", written.shard,
                     "I/N, I from 0 to N - 1: only frames whose number modulo N is I; or `slurm`, what "
                     "Slurm says of an array's task");
  command.add_flag(
      "--resume", written.options.capture.resume,
      "keep the frames that the same run has left in the directory, measure those that are missing");
}

void add_merging(CLI::App &command, Written &written) {
  command.add_option("DIR", written.options.merged, "directories with frames of the same run")->required();
  command.add_option("-o,--output", written.options.capture.output_directory,
                     "output directory [none: the manifest of DIR is made again]");
  add_frames(command, written);
}

void add_paths(CLI::App &command, Written &written) {
  command.add_option("--paths", written.paths,
                     "paths that the reference follows for each pixel where light bounces, 16 to 1e9; only "
                     "with --device reference");
}

void add_importing(CLI::App &command, Written &written) {
  command
      .add_option("FILE", written.options.calibration,
                  "calibration: OpenCV's FileStorage (YAML or JSON) or ROS's camera_info (YAML)")
      ->required();
  command.add_option("--pixel-pitch-m", written.options.pixel_pitch_m,
                     fmt::format("distance from pixel to pixel along the columns, metres, 1e-9 to 1000 [{}]",
                                 default_pixel_pitch_m));
  command.add_option("--name", written.options.sensor_name, "the sensor's name, instead of the file's");
}

void add_suite(CLI::App &bench, Written &written) {
  SuiteOptions &suite = written.suite;
  CLI::Option *named = bench.add_option("--suite", written.suite_name,
                                        "instead of a setup: `real`, procedural scenes, checked and timed");
  named->check(CLI::IsMember({"real"}))
      ->excludes(bench.get_option("SETUP"))
      ->excludes(bench.get_option("--samples"));
  bench.add_option("--kinds", suite.kinds, "of scenes, separated by commas [all but the awkward ones]")
      ->delimiter(',')
      ->needs(named);
  bench
      .add_option("--triangles", suite.triangles,
                  fmt::format("of each scene, about, 1000 to 10000000 [{}]", suite.triangles))
      ->check(CLI::Range(1000, 10'000'000))
      ->needs(named);
  bench
      .add_option("--columns", suite.columns,
                  fmt::format("and rows of the suite's frames, 8 to 8192 [{}]", suite.columns))
      ->check(CLI::Range(8, 8192))
      ->needs(named);
  CLI::Option *against = bench.add_option("--against", suite.peer,
                                          "a program that makes the same frames, to be raced with the suite");
  against->needs(named);
  bench.add_option("--write-scenes", suite.directory, "write the suite's scenes there and time nothing")
      ->needs(named)
      ->excludes(against);
}

// The channels that `render` writes.
std::string channel_list() {
  std::string text = "Channels:\n";
  for (const ChannelRow &row : channel_rows) {
    const std::string name =
        is_of_taps(row) ? fmt::format("{0}0, {0}1, ...", row.name) : std::string(row.name);
    text += fmt::format("  {:<26}{:<14}{}\n", name, row.unit, row.about);
  }
  return text;
}

void add_commands(CLI::App &app, Written &written) {
  CLI::App *render =
      app.add_subcommand("render", "measure frames: amplitude, phase, distance and ground truth");
  add_setup(*render, written, Setups::several);
  add_writing(*render, written);
  add_measuring(*render, written);
  add_paths(*render, written);
  render->footer(channel_list());

  CLI::App *deform =
      app.add_subcommand("deform", "bistatic minus monostatic distance: map, profile, statistics");
  add_setup(*deform, written);
  add_writing(*deform, written);
  add_measuring(*deform, written);
  add_paths(*deform, written);

  CLI::App *check = app.add_subcommand("check", "validate a setup and print what follows from it");
  add_setup(*check, written);

  CLI::App *bench =
      app.add_subcommand("bench", "throughput: frames/s, interactions/s, time per pass, beside native code");
  add_setup(*bench, written, Setups::none_or_one);
  add_measuring(*bench, written);
  add_suite(*bench, written);

  CLI::App *tradeoff = app.add_subcommand(
      "tradeoff",
      "speed against accuracy, of modes, precisions and samples: the first sensor's first frame at "
      "its first frequency, all taps at once");
  add_setup(*tradeoff, written);
  add_output(*tradeoff, written);
  add_samples(*tradeoff, written);
  tradeoff->add_option("--device", written.options.capture.device,
                       "part of a device's name, or its index (see `pmdsim devices`)");

  CLI::App *noise = app.add_subcommand(
      "noise", "of sensors with electronics: photon transfer curve, and precision against distance and "
               "reflectivity, predicted and found in frames");
  add_setup(*noise, written);
  add_output(*noise, written);

  CLI::App *merge = app.add_subcommand(
      "merge", "bring the frames of several directories, as --shard leaves them, together in one");
  add_merging(*merge, written);

  CLI::App *import_calibration = app.add_subcommand(
      "import-calibration", "print a sensor, for a setup, from what calibration tools write");
  add_importing(*import_calibration, written);

  CLI::App *devices = app.add_subcommand("devices", "list the devices that --device takes");
  for (CLI::App *command :
       {render, deform, check, bench, tradeoff, noise, merge, import_calibration, devices})
    command->add_flag("--json", written.options.json,
                      "print one JSON object on stdout and nothing else there");
}

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
}

Options checked(Written written, const std::string &command) {
  Options &options = written.options;
  CaptureRequest &capture = options.capture;
  options.command = command;
  take_setups(written.setups, options);
  check_importing(options);
  check_comparing(written);
  capture.accuracy = accuracy_of(written.accuracy, names_the_reference(capture.device));
  options.mode_written = written.accuracy.mode.has_value();
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
  if (command == "merge" && capture.output_directory.empty() && options.merged.size() > 1)
    throw Error(ExitCode::usage,
                fmt::format("merge: expected -o beside {} directories", options.merged.size()));
  if (capture.output_directory.empty() && command != "merge")
    capture.output_directory = options.setups.size() > 1
                                   ? std::filesystem::path("out") / command
                                   : std::filesystem::path("out") / capture.setup.stem() / command;
  if (written.formats.empty() && default_formats.contains(command))
    written.formats = default_formats.at(command);
  if (!written.channels.empty())
    capture.channels = wanted_channels(written.channels, command);
  for (const std::string &format : written.formats)
    capture.formats.insert(format_names.at(format));
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

// The failure in one line, as CLI11's messages may have more; of an unknown command CLI11 says only that one
// is missing.
std::string parse_failure(const CLI::App &app, const CLI::ParseError &error) {
  std::string text = app.get_subcommands().empty() && !app.remaining().empty()
                         ? fmt::format("unknown command or option {}", app.remaining().front())
                         : error.what();
  text.erase(text.find_last_not_of('\n') + 1);
  std::ranges::replace(text, '\n', ' ');
  return text + " (see pmdsim --help)";
}

} // namespace

std::optional<Options> parse_options(int argument_count, const char *const *arguments) {
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
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError &error) {
    if (error.get_exit_code() != 0)
      throw Error(ExitCode::usage, parse_failure(app, error));
    app.exit(error);
    return std::nullopt;
  }
  if (!manual.empty()) {
    fmt::print("{}", manual_of(table_of(app), manual));
    return std::nullopt;
  }
  return checked(written, app.get_subcommands().front()->get_name());
}

} // namespace pmdsim
