// Images that the reference makes of shipped scenes, in double, at a quarter of their pixels a side: flat and
// smooth surfaces come back within 2 micrometres. The reference shares no code with the correction.

#include "engine/reference/reference.h"
#include "host/input/setup/setup.h"
#include "tests/correction/forward.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// Whether all that a pixel and its eight neighbours see is one plane: facets of the room's sphere are smaller
// than these pixels, and no image tells which way one faces.
bool sees_one_plane(const Scene &scene, const reference::Frame &frame, std::uint32_t row,
                    std::uint32_t column) {
  const auto normal_at = [&](std::uint32_t y, std::uint32_t x) {
    const std::uint32_t id = frame.triangle_id[std::size_t{y} * frame.resolution.x + x];
    if (id == no_id)
      return glm::dvec3(0.0);
    const auto &[a, b, c] = scene.triangles[id].vertices;
    const std::vector<glm::dvec3> &p = scene.positions_m;
    return glm::normalize(glm::cross(p[b] - p[a], p[c] - p[a]));
  };
  for (std::uint32_t y = std::max(row, 1u) - 1; y <= std::min(row + 1, frame.resolution.y - 1); ++y)
    for (std::uint32_t x = std::max(column, 1u) - 1; x <= std::min(column + 1, frame.resolution.x - 1); ++x)
      if (!(glm::distance(normal_at(y, x), normal_at(row, column)) < 1e-6))
        return false;
  return true;
}

void make_coarse(Sensor &sensor, std::uint32_t times) {
  sensor.resolution /= times;
  sensor.pixel_pitch_m *= times;
}

} // namespace

TEST_CASE("shipped scenes come back within 2 micrometres") {
  for (const char *name :
       {"paper_ring", "paper_half_ring", "paper_moire", "closed_box", "room", "signal", "light"}) {
    const Setup setup = load_setup(fmt::format(PMDSIM_SCENES "/{}.json", name));
    Sensor sensor = setup.start.sensors[0];
    make_coarse(sensor, 4);
    const reference::Frame frame =
        reference::simulate(setup.start.scene, sensor, setup.start.illuminators, setup.backscatter);
    const CorrectedImage corrected = correct(sensor, setup.start.illuminators, {frame.returns[0].phase_rad},
                                             {.backscatter = setup.backscatter});
    double flat_m = 0.0;
    std::size_t flat = 0;
    for (std::uint32_t row = 0; row < sensor.resolution.y; ++row)
      for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
        const std::size_t pixel = std::size_t{row} * sensor.resolution.x + column;
        if (corrected.status[pixel] != 0 || !sees_one_plane(setup.start.scene, frame, row, column))
          continue;
        ++flat;
        flat_m = std::max(flat_m, std::abs(corrected.range_m[pixel] - frame.range_m[pixel]));
      }
    fmt::print("{:<16} {:6} flat pixels, off by {:8.2g} um at most; {:5} at edges\n", name, flat,
               1e6 * flat_m, corrected.counts[1]);
    INFO(name);
    CHECK(flat > sensor.pixel_count() / 3);
    CHECK(corrected.counts[2] + corrected.counts[3] + corrected.counts[4] == 0);
    CHECK(flat_m < promised_m);
  }
}
