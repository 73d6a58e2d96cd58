// Amplitudes that the reference must give, in closed form.

#include "engine/reference/reference.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

double amplitude(const Scene &scene, const Diode &diode, Backscatter backscatter) {
  const Sensor sensor = axial_sensor();
  return reference::simulate(scene, sensor, {diode_beside_lens(sensor, diode)}, backscatter)
      .returns[0]
      .amplitude[0];
}

// Through (0, 0, z), its normal tilted from the direction to the lens towards +x.
Scene tilted_wall(double z_m, double tilt_rad) {
  const glm::dvec3 centre_m(0, 0, z_m), down(0, 5, 0),
      across(5 * std::cos(tilt_rad), 0, 5 * std::sin(tilt_rad));
  SceneBuilder builder;
  builder.add_mesh({centre_m - across - down, centre_m - across + down, centre_m + across + down,
                    centre_m + across - down},
                   {{0, 1, 2}, {0, 2, 3}});
  return builder.scene();
}

} // namespace

TEST_CASE("amplitude falls with the square of the diode's distance") {
  const double z_m = GENERATE(0.5, 1.0, 3.0, 8.0);
  CHECK(amplitude(wall_at(z_m), {}, Backscatter::constant) == Approx(1 / (z_m * z_m)).epsilon(1e-10));
}

TEST_CASE("amplitude is proportional to intensity and reflectivity") {
  Diode diode;
  diode.intensity_w_sr = 3;
  CHECK(amplitude(wall_at(1, {0.2}), diode, Backscatter::constant) == Approx(0.6).epsilon(1e-10));
  CHECK(amplitude(wall_at(1, {0.2}), diode, Backscatter::lambert) ==
        Approx(0.6 / std::numbers::pi).epsilon(1e-10));
}

TEST_CASE("a Lambertian wall returns the cosine to the diode, a constant one does not") {
  const double tilt_rad = GENERATE(0.0, 0.5, 1.0, -0.7);
  const Scene scene = tilted_wall(2, tilt_rad);
  CHECK(amplitude(scene, {}, Backscatter::lambert) ==
        Approx(std::cos(tilt_rad) / (4 * std::numbers::pi)).epsilon(1e-6));
  CHECK(amplitude(scene, {}, Backscatter::constant) == Approx(0.25).epsilon(1e-6));
}

TEST_CASE("the angle of incidence is the diode's, not the lens's") {
  const Diode diode = diode_at({2, 0, 0});
  CHECK(amplitude(wall_at(2), diode, Backscatter::lambert) ==
        Approx(std::cos(std::numbers::pi / 4) / (8 * std::numbers::pi)).epsilon(1e-6));
}

TEST_CASE("a diode behind the surface that the lens sees adds nothing") {
  const auto backscatter = GENERATE(Backscatter::constant, Backscatter::lambert);
  const Diode diode = diode_at({0.3, 0, 4});
  const Sensor sensor = axial_sensor();
  const auto frame = reference::simulate(wall_at(2), sensor, {diode_beside_lens(sensor, diode)}, backscatter);
  CHECK(frame.returns[0].amplitude[0] == 0);
  CHECK(std::isnan(frame.returns[0].phase_rad[0]));
  CHECK(std::isnan(frame.returns[0].distance_m[0]));
  CHECK(frame.range_m[0] == Approx(2));
}

TEST_CASE("the normal turns to the lens on the back of a double-sided surface") {
  SceneBuilder builder;
  builder.add_triangle({-5, -5, 2}, {5, 5, 2}, {-5, 5, 2}, {1.0, true});
  const Diode in_front = diode_at({0.1, 0, 0}), behind = diode_at({0.1, 0, 4});
  CHECK(amplitude(builder.scene(), in_front, Backscatter::constant) > 0.2);
  CHECK(amplitude(builder.scene(), behind, Backscatter::constant) == 0);
}

TEST_CASE("a diode's diagram is the cosine to its own axis, to the power of its order") {
  const double order = GENERATE(0.0, 1.0, 2.5, 30.0, 100.0);
  const double angle_rad = GENERATE(0.0, 0.3, 1.2);
  Diode diode;
  diode.axis = {std::sin(angle_rad), 0, std::cos(angle_rad)};
  diode.pattern = {Pattern::Kind::cosine, order};
  CHECK(amplitude(wall_at(1), diode, Backscatter::constant) ==
        Approx(std::pow(std::cos(angle_rad), order)).epsilon(1e-6));
}

TEST_CASE("behind a diode there is light only if it is isotropic") {
  Diode diode;
  diode.axis = {0.6, 0, -0.8};
  CHECK(amplitude(wall_at(1), diode, Backscatter::constant) == Approx(1).epsilon(1e-6));
  diode.pattern = {Pattern::Kind::cosine, GENERATE(0.0, 1.0, 2.0)};
  CHECK(amplitude(wall_at(1), diode, Backscatter::constant) == 0);
}

TEST_CASE("the light's own pose turns positions and axes") {
  const Sensor sensor = axial_sensor();
  Illuminator illuminator = diode_beside_lens(sensor, {{0, 0, 1}, {0, 0, 1}, 1, {Pattern::Kind::cosine, 1}});
  // Its +z is the camera's +x: the diode sits at (1, 0, 0) and looks along +x, away from the wall's centre.
  illuminator.world_from_illuminator =
      compose(sensor.world_from_camera, {glm::dmat3(0, 0, -1, 0, 1, 0, 1, 0, 0), glm::dvec3(0)});
  CHECK(
      reference::simulate(wall_at(1), sensor, {illuminator}, Backscatter::constant).returns[0].amplitude[0] ==
      0);
  illuminator.diodes[0].axis = {-1, 0, 0};
  CHECK(
      reference::simulate(wall_at(1), sensor, {illuminator}, Backscatter::constant).returns[0].amplitude[0] ==
      Approx(std::cos(std::numbers::pi / 4) / 2).epsilon(1e-6));
}

TEST_CASE("vignetting takes the fourth power of the cosine from what is off the axis") {
  Sensor sensor;
  sensor.resolution = {5, 5};
  sensor.pixel_pitch_m = glm::dvec2(0.05);
  sensor.focal_length_m = 0.1;
  const Illuminator light = monostatic_illuminator(sensor.world_from_camera);
  const auto plain = reference::simulate(wall_at(2), sensor, {light}, Backscatter::lambert);
  sensor.vignetting = Vignetting::cos4;
  const auto vignetted = reference::simulate(wall_at(2), sensor, {light}, Backscatter::lambert);
  for (std::size_t pixel = 0; pixel < 25; ++pixel) {
    const double cosine = 2 / plain.range_m[pixel];
    CHECK(vignetted.returns[0].amplitude[pixel] ==
          Approx(plain.returns[0].amplitude[pixel] * std::pow(cosine, 4)).epsilon(1e-13));
    CHECK(vignetted.returns[0].phase_rad[pixel] == Approx(plain.returns[0].phase_rad[pixel]).epsilon(1e-14));
    CHECK(vignetted.range_m[pixel] == plain.range_m[pixel]);
  }
}

TEST_CASE("the frame of many diodes is the sum of their frames", "[smoke]") {
  Random random(11);
  const Pose world_from_camera = random.pose(3);
  const Scene scene = random_triangles(random, 60, world_from_camera);
  Sensor sensor;
  sensor.resolution = {16, 12};
  sensor.pixel_pitch_m = glm::dvec2(0.01);
  sensor.world_from_camera = world_from_camera;
  const Illuminator all = random_illuminator(random, 9, world_from_camera);

  const auto together = reference::simulate(scene, sensor, {all}, Backscatter::lambert);
  std::vector<std::complex<double>> z(together.returns[0].z.size());
  for (const Diode &diode : all.diodes) {
    const auto alone =
        reference::simulate(scene, sensor, {{"one", world_from_camera, {diode}}}, Backscatter::lambert);
    for (std::size_t pixel = 0; pixel < z.size(); ++pixel)
      z[pixel] += alone.returns[0].z[pixel];
  }
  double largest_error = 0;
  for (std::size_t pixel = 0; pixel < z.size(); ++pixel)
    largest_error = std::max(largest_error, std::abs(together.returns[0].z[pixel] - z[pixel]));
  CHECK(*std::max_element(together.returns[0].amplitude.begin(), together.returns[0].amplitude.end()) > 0.01);
  CHECK(largest_error < 1e-14);
}
