#include "host/command_line/command_examples.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>
#include <vector>

namespace pmdsim {
namespace {

constexpr auto examples = std::to_array<CommandExample>({
    {"new", "pmdsim new room", "a room to begin with, in the new folder room"},
    {"new", "pmdsim new star targets/star --distance-m 1.5 --spokes 48",
     "a target of another size, elsewhere"},
    {"new", "pmdsim new checkerboard --squares 7 --force", "again, in place of what is there"},
    {"render", "pmdsim render room/setup.json -o room/out", "pictures, channels and a manifest"},
    {"render", "pmdsim render room/setup.json --max-error 0.1mm --channels distance_m,lit --format npy,png",
     "as fast as the error allows, two channels"},
    {"render", "pmdsim render room/setup.json --samples 4 --set sensors/0/taps=8 -o room/fine",
     "more samples and taps than the setup says"},
    {"render",
     "pmdsim render room/setup.json --variants study.jsonl --shard 0/4 --resume --format npz -o room/study",
     "the first of four shares of a parameter study, a change a line"},
    {"deform", "pmdsim deform room/setup.json -o room/deform", "a map, a profile and statistics"},
    {"deform", "pmdsim deform room/setup.json --samples 1 --json", "figures for scripts"},
    {"check", "pmdsim check room/setup.json", "field of view, ambiguity ranges, diodes, warnings"},
    {"check", "pmdsim check room/setup.json --set illuminators/0/intensity_w_sr=2 --json",
     "of a changed setup, for scripts"},
    {"bench", "pmdsim bench room/setup.json", "every mode of one setup"},
    {"bench", "pmdsim bench room/setup.json --mode exact --json", "one mode, for scripts"},
    {"bench", "pmdsim bench --suite real --kinds room,crowd --triangles 10000", "procedural scenes"},
    {"tradeoff", "pmdsim tradeoff room/setup.json -o room/tradeoff", "a table and a picture"},
    {"tradeoff", "pmdsim tradeoff room/setup.json --samples 1 --json", "points for scripts"},
    {"noise",
     "pmdsim noise room/setup.json --set sensors/0/electronics/preset=kinect_v2_like "
     "--set sensors/0/electronics/integration_time_s=0.001 --set sensors/0/electronics/lens_f_number=1.4",
     "of a sensor with a preset's electronics"},
    {"noise", "pmdsim noise scenes/electronics/kinect_v2_like.json -o out/noise", "of a setup that has them"},
    {"correct", "pmdsim correct room/setup.json room/out -o room/corrected",
     "the frames that render has left in room/out"},
    {"correct", "pmdsim correct room/setup.json room/out/camera_0000.exr --normals 5 --format npz,ply",
     "an image alone; NPY, HDF5, PNG and text do as well"},
    {"diodes", "pmdsim diodes room/setup.json -o room/diodes",
     "tolerances of 0.1 mm, 1 degree, 5 % and so on"},
    {"diodes", "pmdsim diodes room/setup.json --position 50um --dead 0% --boards 1000 --json",
     "other tolerances, for scripts"},
    {"merge", "pmdsim merge room/out", "the manifest of a folder made again from its frames"},
    {"merge", "pmdsim merge part0 part1 -o whole", "what render --shard 0/2 and 1/2 have left"},
    {"report", "pmdsim report room/out", "the page of a run that has ended"},
    {"report", "pmdsim report room/out --json", "its path, for scripts"},
    {"import-calibration", "pmdsim import-calibration camera.yml --pixel-pitch-m 15e-6",
     "OpenCV's calibration as a sensor of a setup"},
    {"import-calibration", "pmdsim import-calibration camera_info.yaml --name left", "ROS's, with a name"},
    {"explain", "pmdsim explain focal_length_m", "a key of a setup"},
    {"explain", "pmdsim explain sensors/0/waveform multipath_m", "a key by its path, and a channel"},
    {"explain", "pmdsim explain exit 8", "an exit code, and what to do then"},
    {"schema", "pmdsim schema", "on stdout"},
    {"schema", "pmdsim schema -o setup.schema.json", "into a file beside a setup"},
    {"devices", "pmdsim devices", "numbers, names and drivers"},
    {"devices", "pmdsim devices --json", "for scripts"},
});

// Lines and what they are for, in columns as far as lines are short.
std::string table_of_lines(const auto &lines, std::size_t column) {
  std::string text;
  for (const auto &[line, about] : lines)
    text += fmt::format("  {:<{}}  {}\n", line, column, about);
  return text;
}

} // namespace

std::span<const CommandExample> command_examples() { return examples; }

std::string examples_text(std::string_view command) {
  constexpr std::size_t widest_column = 60;
  std::vector<std::pair<std::string_view, std::string_view>> lines;
  std::size_t column = 0;
  for (const auto &[of, line, about] : examples)
    if (of == command) {
      lines.emplace_back(line, about);
      column = line.size() <= widest_column ? std::max(column, line.size()) : column;
    }
  return lines.empty() ? "" : "Examples:\n" + table_of_lines(lines, column);
}

std::string first_steps() {
  constexpr auto steps = std::to_array<std::pair<std::string_view, std::string_view>>({
      {"pmdsim new room", "write a setup and its scene into the folder room, every line explained"},
      {"pmdsim check room/setup.json", "is it valid, and what follows from it"},
      {"pmdsim render room/setup.json -o room/out", "measure it; pictures and all channels go to room/out"},
      {"pmdsim explain modulation_hz", "what a key of a setup, a channel or an exit code means"},
      {"pmdsim --help", "all commands; pmdsim COMMAND --help has examples of each"},
  });
  return "pmdsim simulates time-of-flight (PMD) cameras whose light comes from many diodes. Begin with:\n\n" +
         table_of_lines(steps, 42);
}

} // namespace pmdsim
