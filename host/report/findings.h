#pragma once
// Findings that follow from a setup before anything is measured, and the view of a sensor's lens.

#include "host/input/setup/setup.h"
#include "host/report/board_findings.h"
#include "host/report/electron_findings.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pmdsim {

// The view of a sensor's lens, by the rays of its image; NaN where the lens has no ray.
struct FieldOfView {
  // Full angles between the image's edges along its middle row and column and along its longer diagonal; each
  // is the sum of two halves about the image's centre, so that a fisheye may see more than 180 degrees.
  double horizontal_deg, vertical_deg, diagonal_deg;
  // Width and height of what the pixel in the image's centre covers of the plane z = 1 m.
  glm::dvec2 footprint_at_1m_m;
  double darkest_corner; // what vignetting leaves in the darkest corner, 1 without
};

FieldOfView field_of_view(const Sensor &sensor);

// The full angles that a glTF camera sees, along the width and the height, degrees.
glm::dvec2 view_of_camera_deg(const GltfPerspective &camera, const Sensor &sensor);
// The focal length by which the sensor's image, without distortion, is as wide; nothing for a fisheye.
std::optional<double> focal_length_like(const GltfPerspective &camera, const Sensor &sensor);

// Columns and rows divided by `factor`, pixels larger in return; a factor up to 1 changes nothing. At least 8
// of each stay, or all where there are fewer: behind a wide lens the device takes no pixel that sees too
// much.
Sensor coarser(Sensor sensor, double factor);

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
  // Among the rays that see something, the share that sees it beyond a frequency's ambiguity range, 0 to 1.
  std::vector<double> shares_beyond;
  std::optional<ElectronFindings> electrons{}; // nothing without electronics
};

// The light of all diodes of one illuminator together, or of all that there are.
struct LightFindings {
  std::size_t diodes = 0;
  double intensity_w_sr = 0.0; // each on its axis, modulated part
  double power_w = 0.0;        // over all directions, modulated part
};

struct Findings {
  // Shapes that may stand between a diode and another shape; 0 where shadows are off.
  std::size_t shadow_casters;
  LightFindings light{};
  std::vector<std::pair<std::string, LightFindings>> illuminators{}; // with their names
  std::vector<BoardFindings> boards{};                               // of each of them
  std::vector<SensorFindings> sensors{};
};

Findings findings_of(const Setup &setup);

// The warnings beyond those of loading the setup. `findings` are the setup's.
std::vector<Warning> warnings_of(const Setup &setup, const Findings &findings);

// c / (2 f) with f the greatest common divisor of the frequencies; nothing where they are not whole numbers
// of hertz.
std::optional<double> common_ambiguity_m(const std::vector<double> &modulation_hz);

} // namespace pmdsim
