#pragma once
// How many samples a pixel takes, as a setup's key "samples" and the command line say it.

#include "engine/model/sensor.h"

#include <nlohmann/json.hpp>

namespace pmdsim {

struct SampleChoice {
  std::uint32_t samples = 1; // Sensor::samples
  bool adaptive = false;     // Sensor::adaptive_samples
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

} // namespace pmdsim
