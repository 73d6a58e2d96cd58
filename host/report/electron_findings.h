#pragma once
// The electrons that a sensor will count, told before a frame is computed.

#include "host/input/setup/setup.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace pmdsim {

// Of the pixels of a coarse frame of direct light that see something, of one image, or of one reading of
// those that are averaged.
struct ElectronFindings {
  double brightest_e = 0.0, darkest_e = 0.0; // of the diodes' mean light, both taps
  double background_e = 0.0, dark_e = 0.0;   // of foreign light where it is strongest, and in the dark
  // The fullest tap's mean over its well, or over the ADC's range if that is less.
  double fullest_over_well = 0.0;
  double share_full = 0.0; // of the pixels, 0 to 1: those that a tap is full of
  // The least and the largest predicted noise of the first frequency; nothing where none can be said.
  std::optional<double> least_noise_m, most_noise_m;
};

// Nothing where the sensor has no electronics, or nothing is seen.
std::optional<ElectronFindings> electron_findings(const Setup &setup, const Sensor &sensor);

// One line for `check`.
std::string electrons_text(const ElectronFindings &findings);
nlohmann::ordered_json electrons_json(const std::optional<ElectronFindings> &findings);

// Nothing where no tap is to be full.
std::optional<Warning> full_warning(const Sensor &sensor, const ElectronFindings &findings);

} // namespace pmdsim
