#pragma once
// The noise of a sensor with electronics, as tables.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// Tap A of evenly lit pixels, without modulation: mean and temporal variance of its digital numbers, as
// predicted and as found in frames (EMVA Standard 1288, release 4.0, section 6.6).
struct TransferPoint {
  double signal_e = 0.0; // of the tap, mean, without the dark current
  double mean_dn = 0.0, variance_dn2 = 0.0;
  double found_mean_dn = 0.0, found_variance_dn2 = 0.0;
  bool is_full = false; // the mean is beyond the well or the ADC's range
};

// The parts of a reading's variance, which add up to 1.
struct NoiseShares {
  double shot = 0.0; // of the own light
  double background = 0.0, dark = 0.0, read = 0.0, adc = 0.0;
};

// "shot", "background", "dark current", "read" or "ADC", whichever is the largest.
std::string limiting_noise(const NoiseShares &shares);

// A wall across the optical axis, in the pixel in the image's centre.
struct PrecisionPoint {
  double reflectivity = 0.0, distance_m = 0.0;
  double signal_e = 0.0;                          // of one image, both taps
  bool is_full = false;                           // a tap is: there is no prediction then
  std::optional<double> predicted_m{}, found_m{}; // standard deviation of distance_m
  NoiseShares shares{};
};

// One sensor at one frequency.
struct NoiseStudy {
  std::string sensor;
  double modulation_hz = 0.0, ambiguity_m = 0.0;
  std::optional<std::size_t> frequency{}; // of several
  std::vector<TransferPoint> transfer{};
  std::vector<PrecisionPoint> precision{}; // by reflectivity, then distance
};

nlohmann::ordered_json noise_json(const std::vector<NoiseStudy> &studies);
// A line a point after a header line.
std::string transfer_csv(const std::vector<NoiseStudy> &studies);
std::string precision_csv(const std::vector<NoiseStudy> &studies);
// For people: the precision at a few distances, and what limits it.
std::string noise_text(const NoiseStudy &study);

} // namespace pmdsim
