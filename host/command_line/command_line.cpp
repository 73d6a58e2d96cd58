#include "host/command_line/command_line.h"

#include "host/command_line/command_examples.h"
#include "host/explain/topics.h"
#include "host/input/calibration/calibration_sensor.h"
#include "host/input/schema/limits.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

void add_setup(CLI::App &command, Written &written, Setups setups = Setups::one) {
  add_setups(command, written.setups, setups);
  add_max_memory(command, written.max_memory);
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

void add_formats(CLI::App &command, Written &written) {
  command
      .add_option("--format", written.formats,
                  fmt::format("what to write: exr, npz, h5, npy, ply, png, csv, separated by commas [{}]",
                              fmt::join(default_formats().at(command.get_name()), ",")))
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(format_names.begin(), format_names.end())));
}

void add_writing(CLI::App &command, Written &written) {
  add_output(command, written);
  add_formats(command, written);
  command
      .add_option(
          "--channels", written.channels,
          "only these, by names separated by commas, e.g. distance_m,lit; without the numbers of taps, "
          "with or without the prefix of a frequency; `all`, and on demand `normals` and `rays`. What no "
          "other "
          "needs is not computed [all]")
      ->delimiter(',');
  command
      .add_option("--output-precision", written.output_precision,
                  "of distances in files, float32 or float64 (npz, h5, npy; exr has what rounding takes in "
                  "channels of their own) [float32]")
      ->check(CLI::IsMember({"float32", "float64"}));
  add_frames(command, written);
  command.add_option("--shard", written.shard,
                     "I/N, I from 0 to N - 1: only frames whose number modulo N is I; or `slurm`, what "
                     "Slurm says of an array's task");
  command.add_flag(
      "--resume", written.options.capture.resume,
      "keep the frames that the same run has left in the directory, measure those that are missing");
  add_report_flag(command, written.reporting);
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
      .add_option(
          "FILE", written.options.calibration,
          "calibration: OpenCV's FileStorage (YAML, JSON, XML), ROS's camera_info, Kalibr's camchain, "
          "or intrinsics as JSON")
      ->required();
  command.add_option("--pixel-pitch-m", written.options.pixel_pitch_m,
                     fmt::format("distance from pixel to pixel along the columns, metres, 1e-9 to 1000 [{}]",
                                 default_pixel_pitch_m));
  command.add_option("--name", written.options.sensor_name, "the sensor's name, instead of the file's");
  command.add_option(
      "--camera", written.options.calibrated_camera,
      "which of several cameras: cam0, cam1 ... of Kalibr's, 1 or 2 of OpenCV's pairs [the first]");
}

void add_schema(CLI::App &command, Written &written) {
  command.add_option("-o,--output", written.options.schema_file, "file for it [stdout]");
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

} // namespace

const std::map<std::string, std::vector<std::string>> &default_formats() {
  static const std::map<std::string, std::vector<std::string>> formats{
      {"render", {"exr", "png"}}, {"deform", {"exr", "png", "csv"}}, {"correct", {"exr", "png"}}};
  return formats;
}

void add_commands(CLI::App &app, Written &written) {
  CLI::App *fresh = app.add_subcommand(
      "new", "write a setup to begin with, every line explained, and its scene, into a new folder");
  add_new(*fresh, written.fresh);

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
  add_strict(*check, written.accuracy);

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

  CLI::App *correct = app.add_subcommand(
      "correct", "a measured phase or distance image to corrected ranges and points, for the setup's diodes");
  add_setup(*correct, written);
  add_correct(*correct, written.correct);
  add_output(*correct, written);
  add_formats(*correct, written);
  add_samples(*correct, written);

  CLI::App *diodes = app.add_subcommand(
      "diodes", "tolerances of the illuminator: how far distances move where diodes are off or dead, which "
                "diodes matter, and what boards do");
  add_setup(*diodes, written);
  add_output(*diodes, written);
  add_diodes(*diodes, written.diodes);

  CLI::App *merge = app.add_subcommand(
      "merge", "bring the frames of several directories, as --shard leaves them, together in one");
  add_merging(*merge, written);
  add_max_memory(*merge, written.max_memory);

  CLI::App *report = app.add_subcommand(
      "report", "a finished run as one page for a browser: pictures, values under the mouse, points to turn");
  add_report(*report, written.reporting);
  add_frames(*report, written);
  add_max_memory(*report, written.max_memory);

  CLI::App *import_calibration = app.add_subcommand(
      "import-calibration", "print a sensor, for a setup, from what calibration tools write");
  add_importing(*import_calibration, written);

  CLI::App *explain = app.add_subcommand(
      "explain",
      "what a key of a setup, a channel, a warning or an exit code means: unit, default, limits, an example");
  add_explain(*explain, written.options.explain);

  CLI::App *schema = app.add_subcommand(
      "schema", "print the JSON Schema of setups, by which editors complete and check them");
  add_schema(*schema, written);

  CLI::App *devices = app.add_subcommand("devices", "list the devices that --device takes");
  for (CLI::App *command : {fresh, render, deform, check, bench, tradeoff, noise, correct, diodes, merge,
                            report, import_calibration, explain, schema, devices}) {
    command->add_flag("--json", written.options.json,
                      "print one JSON object on stdout and nothing else there");
    const std::string more = command->get_footer();
    command->footer(examples_text(command->get_name()) + (more.empty() ? "" : "\n" + more));
  }
}

void add_suggestions(CommandTable &table) {
  std::vector<std::string> channels;
  for (const ChannelRow &row : channel_rows)
    channels.emplace_back(row.name);
  channels.emplace_back(deformation_channel);
  suggest(table, "--channels", channels);
  suggest(table, "--device", {"cpu", "gpu", "reference"});
  suggest(table, "--quantity", {"distance", "phase", "depth"});
  suggest(table, "--unit", {"m", "mm", "rad", "turns"});
  suggest(table, "--samples", {"auto"});
  suggest(table, "--shard", {"slurm"});
  suggest(table, "KEY", topic_names());
}

} // namespace pmdsim
