// The lens that raster and search are planned with: rays and places on the chip, and where it folds over.

#include "engine/lens/lens.h"
#include "tests/support/random_cameras.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// A square chip whose corners lie at the given slope, of 8 x 8 pixels behind a lens of 10 mm.
Sensor sensor_to(double corner_slope, const Distortion &distortion) {
  Sensor sensor;
  sensor.resolution = {8, 8};
  sensor.focal_length_m = 10e-3;
  sensor.pixel_pitch_m = glm::dvec2(2.0 * sensor.focal_length_m * corner_slope / std::sqrt(2.0) / 8.0);
  sensor.distortion = distortion;
  return sensor;
}

// The largest value of r (1 - k r^2), which rises up to r = sqrt(1 / (3 k)).
double fold_of_barrel(double k) { return 2.0 / 3.0 * std::sqrt(1.0 / (3.0 * k)); }

double distorted_radius(const Lens::Coefficients &c, double r) {
  double sum = 0.0;
  for (std::size_t n = 4; n-- > 0;)
    sum = (sum + c.radial[n]) * r * r;
  return r * (1.0 + sum);
}

std::string fault_of(const Sensor &sensor) {
  const auto fault = lens_fault(sensor);
  if (!fault)
    return "none";
  switch (*fault) {
  case LensFault::chip_behind_lens:
    return "chip behind the lens";
  case LensFault::distortion_folds:
    return "folds";
  case LensFault::beyond_model:
    return "beyond the model";
  case LensFault::pixel_too_wide:
    return "a pixel is too wide";
  }
  return "unknown";
}

} // namespace

TEST_CASE("a place on the chip and its ray lead to each other", "[smoke]") {
  Random random(11);
  int brown = 0, fisheye = 0, pinhole = 0;
  for (int i = 0; i < 300; ++i) {
    const Sensor sensor = random_camera(random, {60, 40});
    if (lens_fault(sensor))
      continue;
    brown += std::holds_alternative<BrownConrady>(sensor.distortion);
    fisheye += std::holds_alternative<Fisheye>(sensor.distortion);
    pinhole += !sensor.has_distortion();
    const Lens lens(sensor);
    for (int j = 0; j < 50; ++j) {
      const glm::dvec2 pixel =
          glm::dvec2(sensor.resolution) * glm::dvec2(random.uniform(0, 1), random.uniform(0, 1));
      const auto ray = lens.ray(lens.on_chip_m(pixel));
      REQUIRE(ray);
      REQUIRE(std::abs(glm::length(*ray) - 1.0) < 1e-14);
      const auto back = lens.chip_m(*ray);
      REQUIRE(back);
      REQUIRE(glm::distance(lens.pixel(*back), pixel) < 1e-9);
      const auto again = lens.ray(*back);
      REQUIRE(again);
      REQUIRE(glm::distance(*again, *ray) < 1e-11);
    }
  }
  CHECK(brown > 40);
  CHECK(fisheye > 40);
  CHECK(pinhole > 40);
}

TEST_CASE("rays by hand") {
  Sensor sensor;
  sensor.resolution = {20, 10};
  sensor.pixel_pitch_m = {1e-3, 1e-3};
  sensor.focal_length_m = 10e-3;
  const auto slope_of = [&](const glm::dvec2 &pixel) {
    const glm::dvec3 ray = *Lens(sensor).ray(Lens(sensor).on_chip_m(pixel));
    return glm::dvec2(ray) / ray.z;
  };
  CHECK(glm::distance(slope_of({20, 0}), {1.0, -0.5}) < 1e-15);
  sensor.chip.translation_m = {1e-3, -2e-3, 10e-3};
  CHECK(glm::distance(slope_of({20, 0}), {0.55, -0.35}) < 1e-15);
  // About x by 30 degrees: the place (0, 5 mm) lies at (0, 5 mm cos 30, 10 mm + 5 mm sin 30).
  sensor.chip = {{30 * degree, 0, 0}, {}};
  CHECK(glm::distance(slope_of({10, 10}), {0.0, 5 * std::cos(30 * degree) / 12.5}) < 1e-15);
  // Brown-Conrady's of (0.3, -0.2): r^2 = 0.13, 1 + k1 r^2 + k2 r^4 + k3 r^6 = 0.96883003, x y = -0.06.
  sensor.chip = {};
  sensor.distortion = BrownConrady{-0.25, 0.08, 1e-3, -2e-3, -0.01};
  CHECK(glm::distance(*Lens(sensor).distorted({0.6, -0.4, 2}), {0.289909009, -0.193316006}) < 1e-9);
  // A fisheye's angle is the slope on the chip's side.
  sensor.distortion = Fisheye{};
  const glm::dvec3 ray = *Lens(sensor).ray({8e-3, 6e-3});
  CHECK(glm::distance(ray, {0.8 * std::sin(1.0), 0.6 * std::sin(1.0), std::cos(1.0)}) < 1e-15);
}

TEST_CASE("a barrel that folds over inside the image is a fault, beyond it none") {
  for (const double k : {0.01, 0.1, 0.3, 0.7, 2.0})
    for (const double beside : {1e-6, 1e-4, 1e-2}) {
      INFO("k1 = " << -k << ", corners beside the fold by " << beside << " of it");
      const double fold = fold_of_barrel(k);
      CHECK(fault_of(sensor_to(fold * (1 - beside), BrownConrady{-k, 0, 0, 0, 0})) == "none");
      CHECK(fault_of(sensor_to(fold * (1 + beside), BrownConrady{-k, 0, 0, 0, 0})) == "folds");
    }
}

TEST_CASE("a fisheye that folds over inside the image is a fault, beyond it none") {
  for (const double k : {0.06, 0.1, 0.3, 0.7, 2.0})
    for (const double beside : {1e-6, 1e-4, 1e-2}) {
      INFO("k1 = " << -k << ", corners beside the fold by " << beside << " of it");
      const double fold = fold_of_barrel(k);
      CHECK(fault_of(sensor_to(fold * (1 - beside), Fisheye{-k, 0, 0, 0})) == "none");
      CHECK(fault_of(sensor_to(fold * (1 + beside), Fisheye{-k, 0, 0, 0})) == "folds");
    }
  // Without coefficients it ends short of the point behind the lens.
  CHECK(fault_of(sensor_to(179 * degree, Fisheye{})) == "none");
  CHECK(fault_of(sensor_to(180 * degree, Fisheye{})) == "beyond the model");
  CHECK(fault_of(sensor_to(60.0, BrownConrady{1e-9, 0, 0, 0, 0})) == "beyond the model");
}

TEST_CASE("tangential distortion that folds over inside the image is a fault, beyond it none") {
  // Along the column in the middle y' = y + 3 p1 y^2 + k1 y^3. It falls back at y = -0.792, y' = -0.371 where
  // p1 = 0.25 and k1 = 0.1, and rises again to where it was, far beyond.
  const double p1 = 0.25, k1 = GENERATE(0.0, 0.1);
  const double y = k1 > 0 ? (-p1 + std::sqrt(p1 * p1 - k1 / 3)) / k1 : -1 / (6 * p1);
  const double fold = std::abs(y + 3 * p1 * y * y + k1 * y * y * y);
  Sensor sensor;
  sensor.resolution = {1, 100};
  sensor.focal_length_m = 10e-3;
  sensor.distortion = BrownConrady{k1, 0, p1, 0, 0};
  const auto fault_with_half_height = [&](double slope) {
    sensor.pixel_pitch_m = {1e-9, 2.0 * slope * sensor.focal_length_m / 100};
    return fault_of(sensor);
  };
  CHECK(fault_with_half_height(fold * (1 - 1e-6)) == "none");
  for (const double beyond : {1e-6, 1e-4, 1e-2, 0.5, 5.0})
    CHECK(fault_with_half_height(fold * (1 + beyond)) == "folds");
}

TEST_CASE("a chip that reaches behind the lens is a fault") {
  // Tilted about x by 60 degrees, its upper edge lies sin 60 times half its height nearer.
  Sensor sensor = sensor_to(1.0, {});
  sensor.chip.rotation_rad.x = 60 * degree;
  const auto fault_with_half_height_m = [&](double half_height_m) {
    sensor.pixel_pitch_m.y = half_height_m / 4;
    return fault_of(sensor);
  };
  const double limit_m = sensor.focal_length_m / std::sin(60 * degree);
  CHECK(fault_with_half_height_m(limit_m * (1 - 1e-9)) == "none");
  CHECK(fault_with_half_height_m(limit_m * (1 + 1e-9)) == "chip behind the lens");
  Sensor turned_round = sensor_to(0.5, {});
  turned_round.chip.translation_m.z = -1.001 * turned_round.focal_length_m;
  CHECK(fault_of(turned_round) == "chip behind the lens");
}

TEST_CASE("the radius of a distorted radius is that of bisection") {
  Random random(12);
  int checked = 0;
  for (int i = 0; i < 400; ++i) {
    const Sensor sensor = random_camera(random, {6, 4});
    if (!sensor.has_distortion() || lens_fault(sensor))
      continue;
    const Lens lens(sensor);
    const double corner = glm::length(*lens.distorted(*lens.ray(lens.on_chip_m({0, 0}))));
    const double distorted = random.uniform(0, 0.9) * corner;
    double low = 0.0, high = 0.0; // `high` walks to the first place that is beyond: the branch from the axis
    while (distorted_radius(lens.coefficients(), high) < distorted)
      low = std::exchange(high, high + 1e-3);
    while (0.5 * (low + high) != low && 0.5 * (low + high) != high)
      (distorted_radius(lens.coefficients(), 0.5 * (low + high)) < distorted ? low : high) =
          0.5 * (low + high);
    REQUIRE(lens.radial_inverse(distorted) == Approx(low).epsilon(1e-12));
    ++checked;
  }
  CHECK(checked > 100);
}

TEST_CASE("S-shaped polynomials are inverted, and are no folds") {
  // Newton's method alone goes round in circles on the first, between 2.4217 and 0.0027.
  std::vector<std::array<double, 3>> shapes{
      {0.65183584760808377, -0.074661211230573163, 0.0013451963068898329}, {0.5, 0.3, 0.2}};
  Random random(17);
  while (shapes.size() < 40)
    shapes.push_back({random.uniform(-0.6, 0.8), random.uniform(-0.1, 0.3), random.uniform(0, 0.05)});
  int without_fold = 0;
  for (const auto &[k1, k2, k3] : shapes) {
    Sensor sensor;
    sensor.distortion = BrownConrady{k1, k2, 0, 0, k3};
    const Lens lens(sensor);
    const auto radial = [k1 = k1, k2 = k2, k3 = k3](double r) {
      const double u = r * r;
      return r * (1 + u * (k1 + u * (k2 + u * k3)));
    };
    // As far as the polynomial rises.
    double end = 0;
    while (end < 2.5 && radial(end + 1e-3) > radial(end))
      end += 1e-3;
    without_fold += end >= 2.5;
    INFO(k1 << ", " << k2 << ", " << k3 << ": rises up to " << end);
    for (int i = 1; i < 2000; ++i) {
      const double r = 0.99 * end * i / 2000;
      REQUIRE(lens.radial_inverse(radial(r)) == Approx(r).epsilon(1e-9));
      REQUIRE(lens.undistorted({0.6 * radial(r), -0.8 * radial(r)}));
    }
  }
  CHECK(without_fold > 5);
}

TEST_CASE("beyond the fold the radius is the fold's") {
  Sensor sensor;
  sensor.distortion = BrownConrady{-0.3, 0, 0, 0, 0};
  CHECK(Lens(sensor).radial_inverse(1.01 * fold_of_barrel(0.3)) == Approx(std::sqrt(1 / 0.9)).epsilon(1e-9));
}
