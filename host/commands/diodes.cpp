#include "engine/model/warning.h"
#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/memory/memory_limit.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"
#include "host/output/pictures/plots.h"
#include "host/output/pictures/preview.h"
#include "host/output/tables/diode_tables.h"
#include "host/report/report.h"
#include "host/tolerance/diode_study.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

DiodeStudy studied(const Setup &setup, const DiodeRequest &request) {
  constexpr double parts = 3.0;
  ProgressBar bar(parts);
  std::string step;
  return study_diodes(setup, request, [&](const char *what, double fraction) {
    throw_if_interrupted();
    if (step != what)
      bar.begin(step = what, 1.0);
    bar.update(fraction);
  });
}

Canvas draw_map(const DiodeStudy &study, const std::vector<double> &values_m, const std::string &what) {
  return draw_preview(study.image_of(values_m, 1e3), study.resolution,
                      {"standard deviation of distance", ColourScale::sequential}, "mm",
                      fmt::format("{}, {}, {}", what, study.sensor, frequency_text(study.modulation_hz)));
}

// What the study is of, its figures aside.
nlohmann::ordered_json head_of(const Setup &setup) {
  return {{"program", "pmdsim"},
          {"version", PMDSIM_VERSION},
          {"command", "diodes"},
          {"setup_file", setup.file.string()},
          {"setup", setup.as_used}};
}

std::vector<std::string> write_files(OutputSet &files, const Setup &setup, const DiodeStudy &study) {
  const auto add = [&](const std::string &name, const auto &write) {
    throw_if_interrupted();
    files.add(name, write);
  };
  add("diodes.csv", [&](OutputFile &file) { file.write(diodes_csv(study)); });
  add("board.csv", [&](OutputFile &file) { file.write(board_csv(study)); });
  add("alike.csv", [&](OutputFile &file) { file.write(alike_csv(study)); });
  add("pixels.csv", [&](OutputFile &file) { file.write(pixels_csv(study)); });
  add("diodes.png", [&](OutputFile &file) { draw_diodes(study).write_png(file); });
  add("tolerance_map.png", [&](OutputFile &file) {
    draw_map(study, study.theory.deviation_m, "what boards differ by").write_png(file);
  });
  add("tolerance_map_varying.png", [&](OutputFile &file) {
    draw_map(study, study.theory.varying_deviation_m, "the same, less each board's offset").write_png(file);
  });
  add("study.txt", [&](OutputFile &file) {
    file.write(fmt::format("{}\n\n{}", setup.file.string(), diode_study_text(study)));
  });
  add("study.json", [&](OutputFile &file) {
    nlohmann::ordered_json json = head_of(setup);
    json.update(diode_study_json(study));
    file.write(json_text(json));
  });
  throw_if_interrupted();
  files.publish();
  return files.paths();
}

// What is found of each pixel and diode, and of each board at the pixels that boards are looked at.
void ask_for_study(const Setup &setup, const DiodeRequest &request) {
  constexpr std::uint64_t bytes_of_pixel = 400, bytes_of_diode = 2000, most_pixels_of_boards = 200;
  std::uint64_t diodes = 0;
  for (const Illuminator &illuminator : setup.start.illuminators)
    diodes += illuminator.diodes.size();
  const std::uint64_t pixels = std::uint64_t{request.pixels} * request.pixels;
  const std::uint64_t of_boards =
      std::min<std::uint64_t>(pixels, most_pixels_of_boards) * request.boards * 2 * sizeof(double);
  ask_for_memory(pixels * (bytes_of_pixel + diodes / 4) + diodes * bytes_of_diode + of_boards,
                 fmt::format("a study of {} diodes, {} boards and {} x {} pixels", diodes, request.boards,
                             request.pixels, request.pixels),
                 "take fewer --boards or --pixels");
}

} // namespace

void run_diodes(const Options &options) {
  const Setup setup = requested_setup(options.capture);
  if (setup.bounces.any())
    warn(
        {std::string(warning_code("bounces-left-out")), setup.file.string() + ": /bounces",
         "light that bounces is left out, as errors of diodes are studied by the light that comes directly"});
  ask_for_study(setup, options.diodes);
  OutputSet files(options.capture.output_directory); // first, so that nothing is studied in vain
  const DiodeStudy study = studied(setup, options.diodes);
  const std::vector<std::string> paths = write_files(files, setup, study);
  if (options.json) {
    nlohmann::ordered_json json = diode_study_json(study);
    json["outputs"] = paths;
    print(json_text(json));
  } else {
    print(fmt::format("{}\nwritten:\n  {}\n", diode_study_text(study), fmt::join(paths, "\n  ")));
  }
}

} // namespace pmdsim
