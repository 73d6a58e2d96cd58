// One bounce between plates, against an integral over the plates.

#include "tests/multipath/frames.h"
#include "tests/reference/bounce_fixture.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

const std::vector<Diode> lamps{diode_at({0.2, 0.1, 0.3}), diode_at({-0.1, -0.15, 0.02})};

struct PlateErrors {
  double quantile_m = 0.0, most_m = 0.0; // 95 % of the pixels and all
  double kept = 0.0;                     // share of pixels that keep what is claimed
};

PlateErrors plate_errors(const std::vector<Plate> &plates, const Bounces &bounces, const char *name,
                         int nodes_a_side = 80) {
  const Sensor sensor = wide_sensor({24, 24}, 1.2);
  const Scene scene = scene_of(plates);
  const Illuminator light{"diodes", sensor.world_from_camera, lamps};
  const Measurement frame = bounced_frame(scene, sensor, {light}, bounces);
  const auto whole = frame_of(scene, sensor, {light});
  std::vector<double> errors_m;
  std::size_t kept = 0;
  for (std::uint32_t pixel = 0; pixel < sensor.pixel_count(); ++pixel) {
    if (whole.object_id[pixel] == no_id || !(whole.returns[0].amplitude[pixel] > 0.0))
      continue;
    const auto z = whole.returns[0].z[pixel];
    const double expected_m = multipath_of_m(
        z + one_bounce_of(plates, sensor, whole, pixel, lamps, nodes_a_side), z, sensor.ambiguity_m());
    errors_m.push_back(std::abs(static_cast<double>(frame.returns[0].multipath_m[pixel]) - expected_m));
    kept += errors_m.back() <= static_cast<double>(frame.returns[0].multipath_error_m[pixel]) ? 1u : 0u;
  }
  std::ranges::sort(errors_m);
  const PlateErrors errors{errors_m[errors_m.size() * 95 / 100], errors_m.back(),
                           static_cast<double>(kept) / static_cast<double>(errors_m.size())};
  fmt::print("{:<16} asked {:.3f} mm, claimed {:.4f}: 95 % within {:.4f} mm, all within {:.4f} mm; {:.1f} % "
             "keep what is claimed\n",
             name, 1e3 * bounces.max_error_m, 1e3 * frame.bounces->claimed_m, 1e3 * errors.quantile_m,
             1e3 * errors.most_m, 100.0 * errors.kept);
  return errors;
}

} // namespace

TEST_CASE("one bounce between plates is within the error asked for of the integral over them") {
  for (const auto &[plates, name] :
       {std::pair(parallel_plates(), "parallel plates"), {corner_of_plates(), "corner"}}) {
    CAPTURE(name);
    const PlateErrors errors = plate_errors(plates, {1, 1e-3}, name);
    CHECK(errors.quantile_m < 1e-3);
    CHECK(errors.kept >= 0.95);
  }
}

TEST_CASE("one bounce between plates is within 0.1 mm of the integral over them", "[long]") {
  for (const auto &[plates, name] :
       {std::pair(parallel_plates(), "parallel plates"), {corner_of_plates(), "corner"}}) {
    CAPTURE(name);
    const PlateErrors errors = plate_errors(plates, {1, 0.1e-3}, name, 200);
    CHECK(errors.most_m < 0.1e-3);
    CHECK(errors.kept >= 0.95);
  }
}
