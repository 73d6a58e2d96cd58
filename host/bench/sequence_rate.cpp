#include "host/bench/sequence_rate.h"

#include "engine/model/error.h"
#include "host/capture/capture.h"
#include "host/capture/exposure.h"
#include "host/capture/frame_sequence.h"
#include "host/capture/frame_writer.h"
#include "host/capture/interruption.h"
#include "host/capture/progress_bar.h"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <set>
#include <string>
#include <system_error>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;

class TemporaryDirectory {
public:
  TemporaryDirectory() {
    std::error_code error;
    const fs::path parent = fs::temp_directory_path(error);
    if (error)
      throw Error(ExitCode::output,
                  fmt::format("TMPDIR: expected a directory for temporary files: {}", error.message()));
    std::string name = (parent / "pmdsim-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error(ExitCode::output, fmt::format("{}: temporary directory cannot be made: {}", name,
                                                std::generic_category().message(errno)));
    path_ = name;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory &) = delete;
  TemporaryDirectory &operator=(const TemporaryDirectory &) = delete;

  const fs::path &path() const { return path_; }

private:
  fs::path path_;
};

// One setup on one device.
class TimedSequences {
public:
  TimedSequences(const Setup &setup, const BenchRequest &request)
      : setup_(setup), exposures_(setup, request.device, true, request.accuracy),
        bar_((3.0 * setup.frames.count + 1.0) * samples_of_frame(setup)), run_{"render",
                                                                               exposures_.camera().device(),
                                                                               exposures_.camera().driver(),
                                                                               request.accuracy,
                                                                               setup.as_used,
                                                                               {}} {}

  void warm_up() {
    for (std::size_t sensor = 0; sensor < setup_.start.sensors.size(); ++sensor)
      take("warming up", sensor, setup_.frames.start_s, std::nullopt);
  }

  // Frames a second.
  double rate(const std::string &what, const std::set<Format> &formats, const TemporaryDirectory &directory) {
    const auto start = std::chrono::steady_clock::now();
    FrameSequence sequence(setup_, {0, setup_.frames.count}, directory.path() / "frames", run_);
    const auto measure = [&](const SensorFrame &at) {
      return rendered_frame(
          exposures_.share(take(fmt::format("{}, {}", what, at.label), at.sensor, at.time_s, at.next_s)), at,
          formats);
    };
    sequence.write(measure, bytes_of_rendered_frame(setup_));
    const std::chrono::duration<double> taken_s = std::chrono::steady_clock::now() - start;
    return setup_.frames.count / taken_s.count();
  }

private:
  TakenFrame take(const std::string &label, std::size_t sensor, double time_s,
                  const std::optional<double> &next_s) {
    bar_.begin(label, samples_of_frame(setup_, setup_.start.sensors[sensor]));
    return exposures_.take(sensor, time_s, Light::beside_lens, interruptible_progress(bar_), next_s);
  }

  const Setup &setup_;
  Exposures exposures_;
  ProgressBar bar_;
  RunRecord run_;
};

} // namespace

SequenceRate measure_sequence_rate(const Setup &setup, const BenchRequest &request, std::uint32_t frames) {
  require_names_for_files(setup.start.sensors);
  Setup several = setup;
  several.frames.count = frames;
  TimedSequences sequences(several, request);
  sequences.warm_up();
  const TemporaryDirectory directory;
  const double measured_per_s = sequences.rate("not written", {}, directory);
  const double npy_per_s = sequences.rate("written as NPY", {Format::npy}, directory);
  const double exr_per_s = sequences.rate("written as EXR", {Format::exr}, directory);
  return {measured_per_s, npy_per_s, exr_per_s, frames};
}

} // namespace pmdsim
