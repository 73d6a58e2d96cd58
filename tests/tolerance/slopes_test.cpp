// Slopes against the reference, which measures with a diode that has really moved.

#include "engine/reference/reference.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/random_diagrams.h"
#include "tests/tolerance/views.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

std::vector<double> distances_m(const Setup &setup, const std::vector<Illuminator> &illuminators) {
  return reference::simulate(setup.start.scene, setup.start.sensors[0], illuminators, setup.backscatter,
                             {.shadows = setup.shadows})
      .returns[0]
      .distance_m;
}

// The diode off by an error in its unit, in the illuminator's frame; `across_x`, `across_y` are the
// directions across its axis there.
Diode with_error(Diode diode, Fault fault, double error, const glm::dvec3 &across_x,
                 const glm::dvec3 &across_y) {
  const auto tilted = [&](const glm::dvec3 &towards) {
    const glm::dvec3 axis = diode.axis;
    diode.axis = std::cos(error) * axis + std::sin(error) * towards;
    const double along = glm::dot(diode.across, towards);
    diode.across += along * (std::cos(error) * towards - std::sin(error) * axis - towards);
  };
  switch (fault) {
  case Fault::x:
  case Fault::y:
  case Fault::z:
    diode.position_m[static_cast<int>(fault)] += error;
    break;
  case Fault::axis_x:
    tilted(across_x);
    break;
  case Fault::axis_y:
    tilted(across_y);
    break;
  case Fault::intensity:
    diode.intensity_w_sr *= 1.0 + error;
    break;
  default:
    break;
  }
  return diode;
}

// The first illuminator's diode `m` off; a phase makes it an illuminator of its own.
std::vector<Illuminator> with_fault(const Setup &setup, const LitView &view, std::size_t m, Fault fault,
                                    double error) {
  std::vector<Illuminator> lights = setup.start.illuminators;
  const TolerancedDiode &in_camera = view.diodes[m];
  const glm::dmat3 illuminator_from_camera = glm::transpose(in_camera.illuminator_axes);
  Diode &diode = lights[0].diodes[m];
  diode = with_error(diode, fault, error, illuminator_from_camera * in_camera.towards_x,
                     illuminator_from_camera * in_camera.towards_y);
  if (fault == Fault::phase) {
    Illuminator alone = lights[0];
    alone.diodes = {diode};
    alone.modulation_phase_rad += error;
    lights[0].diodes.erase(lights[0].diodes.begin() + static_cast<std::ptrdiff_t>(m));
    lights.push_back(alone);
  }
  return lights;
}

struct SlopeErrors {
  double largest_m = 0.0, largest_slope_m = 0.0;
  std::size_t compared = 0;
};

// Of every pixel, by a central difference.
SlopeErrors compare(const Setup &setup, std::size_t m, Fault fault) {
  constexpr double step = 1e-6; // m, rad or share
  const Sensor &sensor = setup.start.sensors[0];
  const LitView view = view_of(setup, all_pixels(sensor));
  REQUIRE(view.points.size() == sensor.pixel_count());
  const std::vector<double> before_m = distances_m(setup, with_fault(setup, view, m, fault, -step)),
                            after_m = distances_m(setup, with_fault(setup, view, m, fault, step));
  SlopeErrors errors;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    if (std::isnan(after_m[i]))
      continue;
    const double found = std::remainder(after_m[i] - before_m[i], sensor.ambiguity_m()) / (2.0 * step);
    const double slope = slope_m(view, view.points[i], m, fault);
    errors.largest_m = std::max(errors.largest_m, std::abs(found - slope));
    errors.largest_slope_m = std::max(errors.largest_slope_m, std::abs(slope));
    ++errors.compared;
  }
  return errors;
}

void check_slopes(const Setup &setup, std::size_t m) {
  for (std::size_t i = 0; i < slope_count; ++i) {
    const auto fault = static_cast<Fault>(i);
    const SlopeErrors errors = compare(setup, m, fault);
    INFO(fault_names[i] << " of diode " << m << ": slopes up to " << errors.largest_slope_m);
    CHECK(errors.compared > 0);
    // The reference's distances, a metre long, are rounded to 2e-16 of that.
    CHECK(errors.largest_m < 1e-6 * errors.largest_slope_m + 2e-8);
  }
}

// A few diodes that look anyhow at a wall that is not across the axis.
Setup random_setup(Random &random, const Waveform &waveform, Backscatter backscatter) {
  Sensor sensor = wide_sensor();
  sensor.resolution = {8, 6};
  sensor.pixel_pitch_m = {1e-3, 1e-3};
  sensor.focal_length_m = 0.007;
  sensor.waveform = waveform;
  sensor.world_from_camera = random.pose(1.0);
  SceneBuilder builder(sensor.world_from_camera);
  const Surface white{.reflectivity = 0.8, .double_sided = true};
  builder.add_mesh({{-9.0, -9.0, 1.2}, {9.0, -9.0, 3.0}, {9.0, 9.0, 3.4}, {-9.0, 9.0, 1.6}},
                   {{0, 2, 1}, {0, 3, 2}}, white);
  Illuminator light = random_illuminator(random, 4, sensor.world_from_camera);
  light.modulation_phase_rad = 0.4;
  for (Diode &diode : light.diodes) {
    diode.intensity_w_sr = random.uniform(0.5, 2.0);
    diode.across = glm::normalize(glm::cross(diode.axis, random.unit_vector()));
  }
  light.diodes[0].pattern = {};
  light.diodes[1].pattern = cosine(2.5);
  light.diodes[2].pattern = {Pattern::Kind::diagram, 0.0, random_diagram(random, true)};
  light.diodes[3].pattern = {Pattern::Kind::diagram, 0.0, random_diagram(random, false)};
  return setup_of(builder.scene(), sensor, {light}, backscatter);
}

const Waveform sine{}, square{Waveform::Kind::square, {}},
    harmonics{Waveform::Kind::harmonics, {1.0, 0.2, 0.15, 0.0, 0.05}};

} // namespace

TEST_CASE("slopes are those of the reference with a diode that has moved") {
  for (std::uint32_t seed = 1; seed <= 3; ++seed)
    for (const Waveform &waveform : {sine, square, harmonics})
      for (const Backscatter backscatter : {Backscatter::lambert, Backscatter::constant}) {
        INFO("seed " << seed << ", waveform " << static_cast<int>(waveform.kind));
        Random random(seed);
        const Setup setup = random_setup(random, waveform, backscatter);
        for (std::size_t m = 0; m < 4; ++m)
          check_slopes(setup, m);
      }
}

TEST_CASE("a dead diode is the reference without it, pixel by pixel, shadows and all") {
  const Setup setup = load_setup(PMDSIM_SCENES "/penumbra.json");
  Setup coarse = setup;
  Sensor &sensor = coarse.start.sensors[0];
  sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / 16.0;
  sensor.resolution = {16, 16};
  sensor.samples = 1;
  std::vector<std::size_t> numbers;
  const LitView view = lit_view(coarse, sensor, all_pixels(sensor), numbers);
  const LinearTheory theory = linear_theory(view, {});
  const std::vector<double> with_m = distances_m(coarse, coarse.start.illuminators);
  for (const std::size_t m : {std::size_t{0}, view.diodes.size() / 3, view.diodes.size() - 1}) {
    std::vector<Illuminator> lights = coarse.start.illuminators;
    lights[0].diodes.erase(lights[0].diodes.begin() + static_cast<std::ptrdiff_t>(m));
    const std::vector<double> without_m = distances_m(coarse, lights);
    double squares = 0.0, most_m = 0.0, count = 0.0;
    for (std::size_t i = 0; i < with_m.size(); ++i)
      if (!std::isnan(without_m[i])) {
        const double change_m = std::remainder(without_m[i] - with_m[i], sensor.ambiguity_m());
        squares += change_m * change_m;
        most_m = std::max(most_m, std::abs(change_m));
        count += 1.0;
      }
    const ImageChange &dead = theory.diodes[m].faults[static_cast<std::size_t>(Fault::dead)];
    CHECK(dead.rms_m == Approx(std::sqrt(squares / count)).epsilon(1e-8));
    CHECK(dead.max_m == Approx(most_m).epsilon(1e-8));
    CHECK(dead.rms_m > 1e-7);
    CHECK(count == static_cast<double>(theory.lit_points - theory.diodes[m].left_dark));
  }
}
