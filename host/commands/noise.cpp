#include "engine/model/error.h"
#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/noise/noise_study.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"
#include "host/output/pictures/plots.h"
#include "host/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

std::string picture_name(const NoiseStudy &study, const std::string &quantity) {
  return fmt::format("{}.{}.png", study.sensor, channel_name(quantity, study.frequency));
}

std::vector<std::string> write_files(OutputSet &files, const std::vector<NoiseStudy> &studies) {
  const auto add = [&](const std::string &name, const auto &write) {
    throw_if_interrupted();
    files.add(name, write);
  };
  add("photon_transfer.csv", [&](OutputFile &file) { file.write(transfer_csv(studies)); });
  add("precision.csv", [&](OutputFile &file) { file.write(precision_csv(studies)); });
  for (const NoiseStudy &study : studies) {
    add(picture_name(study, "precision"), [&](OutputFile &file) { draw_precision(study).write_png(file); });
    if (!study.transfer.empty())
      add(fmt::format("{}.photon_transfer.png", study.sensor),
          [&](OutputFile &file) { draw_transfer(study).write_png(file); });
  }
  throw_if_interrupted();
  files.publish();
  return files.paths();
}

std::string text_of(const std::vector<NoiseStudy> &studies) {
  std::string text;
  for (const NoiseStudy &study : studies)
    text += fmt::format("sensor {} at {}: standard deviation of distance, and what limits it\n{}\n",
                        study.sensor, frequency_text(study.modulation_hz), noise_text(study));
  return text;
}

} // namespace

void run_noise(const Options &options) {
  const Setup setup = requested_setup(options.capture);
  require_names_for_files(setup.start.sensors);
  OutputSet files(options.capture.output_directory); // first, so that nothing is studied in vain
  const std::vector<NoiseStudy> studies = study_noise(setup, [](double) { throw_if_interrupted(); });
  const std::vector<std::string> paths = write_files(files, studies);
  if (options.json) {
    nlohmann::ordered_json json = noise_json(studies);
    json["outputs"] = paths;
    print(json_text(json));
  } else {
    print(fmt::format("{}written:\n  {}\n", text_of(studies), fmt::join(paths, "\n  ")));
  }
}

} // namespace pmdsim
