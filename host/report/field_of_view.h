#pragma once
// What a sensor's lens shows it, by the rays of its image, and the same view with fewer pixels.

#include "engine/model/sensor.h"

namespace pmdsim {

// NaN where the lens has no ray.
struct FieldOfView {
  // Full angles between the image's edges along its middle row and column and along its longer diagonal; each
  // is the sum of two halves about the image's centre, so that a fisheye may see more than 180 degrees.
  double horizontal_deg, vertical_deg, diagonal_deg;
  // Width and height of what the pixel in the image's centre covers of the plane z = 1 m.
  glm::dvec2 footprint_at_1m_m;
  double darkest_corner; // what vignetting leaves in the darkest corner, 1 without
};

FieldOfView field_of_view(const Sensor &sensor);

// Columns and rows divided by `factor`, pixels larger in return; a factor up to 1 changes nothing. At least 8
// of each stay, or all where there are fewer: behind a wide lens the device takes no pixel that sees too
// much.
Sensor coarser(Sensor sensor, double factor);

} // namespace pmdsim
