#include "host/bench/timing.h"

#include "host/bench/temporary_directory.h"
#include "host/capture/capture.h"

#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <string>

namespace pmdsim {

SequenceRate measure_sequence_rate(const Setup &setup, const BenchRequest &request, std::uint32_t frames) {
  require_names_for_files(setup.start.sensors);
  Setup several = setup;
  several.frames.count = frames;
  Exposures exposures(several, request.device, true, request.accuracy);
  ProgressBar bar((3.0 * frames + 1.0) * samples_of_frame(several));
  const auto take = [&](const std::string &label, std::size_t sensor, std::uint32_t frame,
                        const std::optional<double> &next_s) {
    bar.begin(label, samples_of_frame(several, several.start.sensors[sensor]));
    return exposures.take(sensor, frame, Light::beside_lens, interruptible_progress(bar), next_s);
  };
  for (std::size_t sensor = 0; sensor < several.start.sensors.size(); ++sensor)
    take("warming up", sensor, 0, std::nullopt);
  const TemporaryDirectory directory;
  const auto frames_per_s = [&](const std::string &what, const std::set<Format> &formats) {
    const auto start = std::chrono::steady_clock::now();
    const Camera &camera = exposures.camera();
    FrameSequence sequence(several, {{0, frames}, directory.path() / "frames"},
                           {.command = "render",
                            .device = camera.device(),
                            .driver = camera.driver(),
                            .accuracy = request.accuracy,
                            .setup = several.as_used});
    const auto measure = [&](const SensorFrame &at) {
      const std::string label = fmt::format("{}, {}", what, at.label);
      return rendered_frame(exposures.share(take(label, at.sensor, at.frame, at.next_s)), at, formats);
    };
    sequence.begin();
    sequence.write(measure, bytes_of_largest_frame(several, true));
    return frames / (1e-3 * ms_since(start));
  };
  const double measured = frames_per_s("not written", {});
  // The smaller files first, as the larger ones leave a disk with more than it has written.
  const double exr = frames_per_s("written as EXR", {Format::exr});
  const double npy = frames_per_s("written as NPY", {Format::npy});
  return {measured, npy, exr, frames};
}

} // namespace pmdsim
