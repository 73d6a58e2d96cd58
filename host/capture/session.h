#pragma once
// One device that measures frames of one setup after another: it, its pipelines and the files of scenes are
// made and read once.

#include "host/capture/exposure.h"
#include "host/input/setup/document.h"
#include "host/input/setup/setup.h"
#include "host/output/files/manifest.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// How frames are measured, beside what the setup says.
struct RenderRequest {
  Accuracy accuracy;
  std::optional<SampleChoice> samples; // instead of the setup's
  std::uint32_t paths = 0;             // of the reference, as Extras
  WantedChannels channels{};
  OutputPrecision output_precision = OutputPrecision::float32;

  bool operator==(const RenderRequest &other) const {
    return accuracy == other.accuracy && samples == other.samples && paths == other.paths &&
           channels.names() == other.channels.names() && output_precision == other.output_precision;
  }
};

class Session {
public:
  // `device` as Camera's. Throws Error (no_device).
  explicit Session(const std::string &device) : camera_(std::make_shared<Camera>(device)) {}

  const std::shared_ptr<Camera> &camera() const { return camera_; }

  // A setup in place of the one before, which stays where this throws Error (input). With a scene the
  // document names none.
  void load(SetupDocument document, std::shared_ptr<const Scene> scene = nullptr);
  // As change() of host/input/setup/document.h, and checked as a setup is: all of it or nothing.
  void set(const nlohmann::json &values);

  bool has_setup() const { return setup_ != nullptr; }
  const Setup &setup() const { return *setup_; }

  // The frame of that number, of the sensor with that index, both of the setup's. Throws Error, interrupted
  // among others where `progress` does.
  TakenFrame take(std::size_t sensor, std::uint32_t number, const RenderRequest &request,
                  const Progress &progress);

private:
  void take_over(SetupDocument document, std::shared_ptr<const Scene> scene, SetupLoader &loader);

  // What frames are taken of; in one place, as exposures look at their setup.
  struct Taking {
    std::shared_ptr<const Setup> setup;
    RenderRequest request;
    Exposures exposures;
  };

  std::shared_ptr<Camera> camera_;
  SetupLoader loader_;
  SetupDocument document_;
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const Setup> setup_;
  std::unique_ptr<Taking> taking_; // of the last frame
};

} // namespace pmdsim
