#pragma once
// Distances of a device against the reference, on pixels chosen at random.

#include "engine/reference/reference.h"
#include "host/input/setup/setup.h"
#include "host/output/tables/tradeoff.h"

#include <vector>

namespace pmdsim {

// `count` of a frame's pixels, ascending, or all where it has no more; the same ones every time.
std::vector<std::uint32_t> random_pixels(std::uint64_t pixels, std::size_t count);

// The reference's frame of some of a sensor's pixels, at its first frequency.
struct TruePixels {
  Sensor sensor;
  std::vector<std::uint32_t> pixels; // row * columns + column
  reference::Frame frame;            // a column of these
};

// Which of the pixels lie on an edge: their samples in the reference and in `found` see more than one
// triangle, or other diodes reach them. `found` is of the same sensor with `samples` x `samples` samples a
// pixel, with its sample triangles.
std::vector<bool> on_edges(const TruePixels &truth, const Measurement &found, std::uint32_t samples,
                           std::size_t diodes);

struct ErrorsByPlace {
  DistanceErrors smooth, edges; // beside edges and on them
};

// The errors of pixels that are not dark in the reference. An error is half the ambiguity range, the largest
// that there is, where the device has no distance. Of unrounded distances where the frame has them.
ErrorsByPlace distance_errors(const TruePixels &truth, const std::vector<bool> &edges,
                              const Measurement &found);

} // namespace pmdsim
