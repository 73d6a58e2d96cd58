#pragma once
// The parts that measuring commands share: what is asked of them, the setup with that, and how its frames
// come into a directory.

#include "host/capture/exposure.h"
#include "host/capture/frame_sequence.h"
#include "host/capture/frame_writer.h"
#include "host/capture/progress.h"
#include "host/capture/variants.h"
#include "host/input/setup/setup.h"
#include "host/output/files/frame_warnings.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

namespace pmdsim {

struct CaptureRequest {
  std::filesystem::path setup;
  nlohmann::json changes = nlohmann::json::object(); // of the setup, as change() takes them
  std::optional<PosesFromFile> poses;                // likewise
  UriFiles scene_files = UriFiles::beside;           // those that its scene names
  std::optional<SampleChoice> samples;               // instead of the setup's
  std::string device;                                // as Camera's
  std::uint32_t paths = 0;                           // of the reference, as Extras
  Accuracy accuracy;
  std::optional<FrameRange> frames; // instead of all of the setup's
  Shard shard;                      // of these
  std::filesystem::path output_directory;
  bool resume = false; // frames that are whole there stay
  ProgressPart part{}; // of the command's work
  std::set<Format> formats;
  WantedChannels channels;
  OutputPrecision output_precision = OutputPrecision::float32;
};

// The setup with what is asked for instead of its own values. Its warnings go to stderr. Throws Error: input,
// usage (paths are asked for where no light bounces).
Setup requested_setup(const CaptureRequest &request);
// The document of that, changed already.
SetupDocument requested_document(const CaptureRequest &request, const std::filesystem::path &file);
// The same of a document, by a loader that others of the same scenes may use.
Setup requested_setup(const CaptureRequest &request, const SetupDocument &document, SetupLoader &loader);
// The same for commands that look at no scene: it is not read.
Setup requested_setup_without_scene(const CaptureRequest &request, const SetupDocument &document);
// What a manifest says of a run of the setup before its frames; without a device.
RunHead head_of(const CaptureRequest &request, const Setup &setup, const std::string &command);
// Throws Error where frames of the setup cannot be measured and written as is asked for: (usage) frames,
// paths or channels that it has not; (input) a sensor's name that can be none of a file, or warnings that are
// to be errors.
void require_measurable(const CaptureRequest &request, const Setup &setup);
// The same for commands that compare ways to sum over the diodes: without bounces, and a warning says so.
Setup requested_setup_without_bounces(const CaptureRequest &request);
// Leaves out what the camera does behind the lens (electronics, scatter, unwrapping), for commands that
// compare frames without, and a warning says so.
void leave_out_electronics(Setup &setup);

// The frames of a setup that one command leaves in a directory, with a bar of its progress.
class Capture {
public:
  // `command` is what the manifest calls it. Without `keep_taps` as Exposures. Throws Error: nothing is
  // measured in vain where a file cannot be written.
  Capture(const CaptureRequest &request, const std::string &command, bool keep_taps)
      : Capture(request, requested_setup(request), command, keep_taps, request.channels) {}
  // Of `setup`, which is the requested one, changed.
  // Measured are the channels that `measured` wants, beside those of the request, and unrounded distances
  // where the request or the command asks for them.
  Capture(const CaptureRequest &request, Setup setup, const std::string &command, bool keep_taps,
          const WantedChannels &measured, bool keep_unrounded = false)
      : Capture(request, std::move(setup), command, keep_taps, measured,
                std::make_shared<Camera>(request.device), keep_unrounded) {}
  // With a camera that nobody else uses meanwhile.
  Capture(const CaptureRequest &request, Setup setup, const std::string &command, bool keep_taps,
          const WantedChannels &measured, const std::shared_ptr<Camera> &camera, bool keep_unrounded = false);

  const Setup &setup() const { return setup_; }
  std::uint32_t frame_count() const { return frames_.count(); } // that were asked for
  const std::set<Format> &formats() const { return formats_; }
  const WantedChannels &channels() const { return channels_; } // of the request
  OutputPrecision output_precision() const { return sequence_.run().output_precision; }
  const FrameSequence &sequence() const { return sequence_; } // with what it has written
  // Of the frames in the directory that were asked for, sensor by sensor, as its records have them. As
  // FrameSequence::for_each_record().
  void for_each_sensor_frame(const std::function<void(const nlohmann::ordered_json &)> &use) const;
  // "device    NAME (DRIVER)" and an empty line.
  std::string device_text() const;

  // A part of a frame; `next_s` as Exposures::take(). `label` follows that of the part. Throws Error (input,
  // accuracy) where the frame has warnings and they are to be errors.
  TakenFrame take(const SensorFrame &at, Light light, std::optional<double> next_s,
                  const std::string &label = "");
  // As Exposures::share().
  std::shared_ptr<const TakenFrame> share(TakenFrame &&frame) { return exposures_.share(std::move(frame)); }
  // As FrameSequence::write(); `measure` takes so many exposures of each sample.
  void write(const FrameSequence::Measure &measure, std::size_t part_bytes, double exposures_of_sample = 1.0);

private:
  std::size_t bytes_of_normals() const; // of the largest sensor's frame
  std::uint64_t room_for_waiting(std::size_t part_bytes) const;
  void tell_warnings();

  Setup setup_;
  FrameRange frames_;
  std::set<Format> formats_;
  WantedChannels channels_;
  Accuracy accuracy_; // asked for
  ProgressPart part_;
  Exposures exposures_;
  FrameSequence sequence_;
  std::optional<ProgressBar> bar_; // while it writes
  FrameWarnings warnings_;         // of the frames that were taken here
};

// A manifest's record of a part of a frame.
FrameRecord record_of(const TakenFrame &taken, const SensorFrame &at);

// A frame as `render` leaves it: every channel of what was taken. Its files hold on to `taken`, and look at
// the names of objects, which pictures show.
MeasuredPart rendered_frame(const std::shared_ptr<const TakenFrame> &taken, const SensorFrame &at,
                            const std::set<Format> &formats, std::span<const std::string> objects = {});

// The bytes of the setup's largest frame of the wanted channels, with or without its taps and unrounded
// distances, and with so many maps of doubles more of each frequency.
std::size_t bytes_of_largest_frame(const Setup &setup, bool keep_taps, const WantedChannels &wanted = {},
                                   std::size_t maps = 0, bool keep_unrounded = false);

} // namespace pmdsim
