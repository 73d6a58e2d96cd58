#pragma once
// Where the edges of triangles and discs lie in the image, in double.

#include "engine/reference/view/camera_frame.h"
#include "engine/reference/view/lens_model.h"

namespace pmdsim::test {

// Angle at the lens from the ray of a sample (column, row in 0 ... S * resolution - 1) to the triangle's
// nearest edge, over the angle from the sample's pixel to the next: in pixels, whatever the lens does to
// straight lines.
double pixels_to_edge(const reference::LensModel &lens, const Sensor &sensor, const glm::uvec2 &sample,
                      const reference::CameraTriangle &triangle);

// The same to the rim of a disc about `centre_m`, camera frame, that faces the lens.
double pixels_to_rim(const reference::LensModel &lens, const Sensor &sensor, const glm::uvec2 &sample,
                     const glm::dvec3 &centre_m, double radius_m);

} // namespace pmdsim::test
