#pragma once
// What follows from a setup before anything is measured.

#include "host/input/setup/setup.h"
#include "host/report/field_of_view.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pmdsim {

// Of one modulation frequency.
struct AmbiguityFinding {
  double modulation_hz, ambiguity_m;
  double share_beyond; // of the rays that see something, those that see it beyond the ambiguity range, 0 to 1
};

// Distances from the lens; NaN where nothing is visible.
struct VisibleRange {
  double min_m = std::numeric_limits<double>::quiet_NaN();
  double max_m = std::numeric_limits<double>::quiet_NaN();

  bool is_empty() const { return std::isnan(min_m); }
};

struct SensorFindings {
  Sensor sensor;
  FieldOfView view;
  VisibleRange visible;
  std::vector<AmbiguityFinding> frequencies;
  std::optional<double> common_ambiguity_m; // of all frequencies together
  double tap_sequence_s; // from a frame's first tap to the end of its last; 0 where all are taken at once
};

// Of all diodes of one illuminator together, or of all that there are.
struct LightFindings {
  std::size_t diodes = 0;
  double intensity_w_sr = 0.0; // each on its axis, modulated part
  double power_w = 0.0;        // over all directions, modulated part
};

struct Findings {
  std::size_t triangles, points;
  Shadows shadows;
  std::size_t
      shadow_casters; // shapes that may stand between a diode and another shape; 0 where shadows are off
  LightFindings light;
  std::vector<std::pair<std::string, LightFindings>> illuminators; // with their names
  std::vector<SensorFindings> sensors;
  FrameTimes frames;
  bool moves; // anything does
};

Findings findings_of(const Setup &setup);

// Beyond what loading the setup has warned of already, one line each.
std::vector<std::string> warnings_of(const Findings &findings);

// c / (2 f) with f the greatest common divisor of the frequencies; nothing where they are not whole numbers
// of hertz.
std::optional<double> common_ambiguity_m(const std::vector<double> &modulation_hz);

} // namespace pmdsim
