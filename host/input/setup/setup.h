#pragma once
// A setup file (docs/setup.md), loaded and checked once.

#include "engine/model/bounces.h"
#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"
#include "engine/model/warning.h"
#include "host/input/file/files_read.h"
#include "host/input/gltf/cameras.h"
#include "host/input/setup/document.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// An illuminator of another camera, with the frequency that it is modulated at.
struct OtherIlluminator {
  double modulation_hz;
  Illuminator illuminator;
};

// The scene, sensors and illuminators at one time.
struct Instant {
  Scene scene;
  std::vector<Sensor> sensors;            // at least one, each with a name of its own
  std::vector<Illuminator> illuminators;  // at least one, each with a name of its own
  std::vector<OtherIlluminator> others{}; // with names of their own, too
};

// When frames are taken.
struct FrameTimes {
  double start_s = 0.0;
  double rate_hz = 1.0;
  std::uint32_t count = 1;
  std::vector<double> times_s{}; // of each frame, those of a trajectory's poses; empty: by the rate

  double time_s(std::uint32_t frame) const {
    return times_s.empty() ? start_s + frame / rate_hz : times_s[frame];
  }
};

// How the scene, the sensors and the illuminators move.
class Motion;

// How many samples a pixel takes, as a setup's key "samples" and the command line say it.
struct SampleChoice {
  std::uint32_t samples = 1; // Sensor::samples
  bool adaptive = false;     // Sensor::adaptive_samples

  bool operator==(const SampleChoice &) const = default;
};

// "auto": S x S samples where they show anything, fewer elsewhere; the reference takes them all.
inline constexpr SampleChoice automatic_samples{.samples = 4, .adaptive = true};

// A number or "auto".
inline SampleChoice sample_choice_of(const nlohmann::ordered_json &samples) {
  return samples == "auto" ? automatic_samples : SampleChoice{.samples = samples};
}
inline nlohmann::ordered_json sample_choice_json(const SampleChoice &choice) {
  return choice.adaptive ? nlohmann::ordered_json("auto") : nlohmann::ordered_json(choice.samples);
}

inline void set_samples(Sensor &sensor, const SampleChoice &choice) {
  sensor.samples = choice.samples;
  sensor.adaptive_samples = choice.adaptive;
}

// The scene's camera at whose node a sensor is; the sensor's lens is its own.
struct SceneCamera {
  std::string node;
  GltfPerspective view;
};

struct Setup {
  std::filesystem::path file;
  Backscatter backscatter = Backscatter::lambert;
  Shadows shadows = Shadows::automatic;
  Bounces bounces;
  FrameTimes frames;
  Instant start;                  // at the first frame's time
  nlohmann::ordered_json as_used; // the setup with every default filled in, as the manifest shows it
  std::vector<FileRead> inputs;   // the files that it names, and those that these name
  std::vector<Warning> warnings;  // e.g. that the scene is empty
  std::vector<std::optional<SceneCamera>> cameras; // beside start.sensors; nothing elsewhere
  std::shared_ptr<const Motion> motion;            // nothing where all stands still

  // Everything in its place at a time; `start` where nothing moves. Throws Error (input).
  Instant at(double time_s) const;
};

// Of all its sensors, in place of their own.
inline void set_samples(Setup &setup, const SampleChoice &choice) {
  for (Sensor &sensor : setup.start.sensors)
    set_samples(sensor, choice);
  for (auto &sensor : setup.as_used["sensors"])
    sensor["samples"] = sample_choice_json(choice);
}

// Throws Error (input) in one line: the file, the place in it and what was expected.
Setup load_setup(const std::filesystem::path &file);

// Loads one setup after the other; the files of scenes are read once.
class SetupLoader {
public:
  SetupLoader();
  ~SetupLoader();
  SetupLoader(SetupLoader &&) noexcept;
  SetupLoader &operator=(SetupLoader &&) noexcept;

  // Throws Error (input).
  Setup load(const SetupDocument &document);
  // With this scene, which has no nodes and does not move, in place of a file; the document names none.
  Setup load(const SetupDocument &document, const std::shared_ptr<const Scene> &given);
  // For what looks at no scene: the document may name one, which is not read. Poses at nodes are errors.
  static Setup load_without_scene(const SetupDocument &document);

private:
  struct Files;
  std::unique_ptr<Files> files_;
};

} // namespace pmdsim
