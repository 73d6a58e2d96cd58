#include "engine/view/seen_outline.h"

#include "engine/view/projection.h"

#include <algorithm>
#include <array>

namespace pmdsim {

Seen seen_in(const RasterBlock &block, std::span<const glm::dvec3> corners_m) {
  // In the raster's frame (x, y, depth), before x and y are divided by the depth.
  std::array<glm::dvec3, 3> places;
  for (std::size_t i = 0; i < corners_m.size(); ++i)
    places[i] = block.raster_from_camera * corners_m[i];
  Seen seen;
  const auto add = [&](const glm::dvec3 &h) {
    seen.outline.add(glm::dvec2(h) / h.z);
    seen.nearest_m = std::min(seen.nearest_m, h.z);
    seen.farthest_m = std::max(seen.farthest_m, h.z);
  };
  for (std::size_t i = 0; i < corners_m.size(); ++i) {
    const glm::dvec3 &from = places[i], &to = places[i + 1 < corners_m.size() ? i + 1 : 0];
    if (from.z >= nearest_depth_m)
      add(from);
    if ((from.z >= nearest_depth_m) != (to.z >= nearest_depth_m))
      add(from + (to - from) * ((nearest_depth_m - from.z) / (to.z - from.z)));
  }
  return seen;
}

} // namespace pmdsim
