#include "tests/support/random_setups.h"

#include "engine/lens/lens.h"
#include "tests/support/random_cameras.h"
#include "tests/support/random_diagrams.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace pmdsim::test {

namespace {

constexpr std::uint32_t seeds_of_a_form = 16;
constexpr glm::uvec2 coarsest(10);
constexpr double most_paths = 1.5e6; // in a frame: samples times diodes times frequencies

template <typename T, std::size_t n>
const T &one_of(Random &random, const std::array<T, n> &choices) {
  return choices[static_cast<std::size_t>(random.uniform(0, n))];
}

// The properties of a setup that shaders are compiled for.
struct Form {
  Waveform waveform;
  std::size_t frequencies;
  std::vector<std::string> patterns; // of each illuminator
  double order;                      // of diagrams that have a whole one
  bool phased;
  Backscatter backscatter;
  Shadows shadows;
};

Waveform random_waveform(Random &random) {
  const double kind = random.uniform(0, 1);
  if (kind < 0.7)
    return {};
  if (kind < 0.85)
    return {Waveform::Kind::square, {}};
  return {Waveform::Kind::harmonics, {1.0, random.uniform(-0.3, 0.3), random.uniform(-0.2, 0.2)}};
}

Form random_form(std::uint32_t number) {
  Random random(1000 + number);
  Form form{random_waveform(random), 1, {}, std::floor(random.uniform(1, 9)), random.flip(), {}, {}};
  form.frequencies = static_cast<std::size_t>(random.uniform(1, 4));
  const std::size_t illuminators = random.uniform(0, 1) < 0.3 ? 2 : 1;
  constexpr std::array kinds{"isotropic", "whole order", "broken order", "narrow beams", "measured", "mixed"};
  form.patterns.push_back(kinds[number % kinds.size()]);
  if (illuminators == 2)
    form.patterns.push_back(one_of(random, kinds));
  form.backscatter = random.flip() ? Backscatter::lambert : Backscatter::constant;
  form.shadows = random.uniform(0, 1) < 0.4 ? Shadows::automatic : Shadows::off;
  return form;
}

// Places in the illuminator's frame, `reach_m` from its origin at most.
std::vector<glm::dvec3> places_m(Random &random, const std::string &layout, std::uint32_t count,
                                 double reach_m) {
  const double golden_angle_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(count)));
  const double turn_rad = random.uniform(0, full_turn_rad);
  const auto at = [](double radius_m, double angle_rad) {
    return glm::dvec3(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), 0.0);
  };
  std::vector<glm::dvec3> places;
  for (std::uint32_t k = 0; k < count; ++k) {
    const double share = (k + 0.5) / count;
    if (layout == "ring")
      places.push_back(at(reach_m * (1.0 - 0.1 * (k % 3)), full_turn_rad * share));
    else if (layout == "disc")
      places.push_back(at(reach_m * std::sqrt(share), golden_angle_rad * k));
    else if (layout == "bar")
      places.push_back(at(reach_m * (2.0 * share - 1.0), turn_rad));
    else if (layout == "grid")
      places.push_back(reach_m * (glm::dvec3(k % columns + 0.5, k / columns + 0.5, 0.0) / (0.7 * columns) -
                                  glm::dvec3(0.7, 0.7, 0.0)));
    else // a cluster
      places.push_back(reach_m * random.uniform(0, 1) * random.unit_vector());
  }
  return places;
}

glm::dvec3 tilted_axis(Random &random, double most_rad) {
  const double tilt_rad = random.uniform(0, most_rad), roll_rad = random.uniform(0, full_turn_rad);
  return {std::sin(tilt_rad) * std::cos(roll_rad), std::sin(tilt_rad) * std::sin(roll_rad),
          std::cos(tilt_rad)};
}

using NextPattern = std::function<Pattern()>;

// The pattern of one diode after the other.
NextPattern patterns_of(Random &random, const std::string &kind, double whole_order) {
  const auto cosine = [](double order) { return Pattern{Pattern::Kind::cosine, order}; };
  const auto always = [](const Pattern &pattern) { return [pattern] { return pattern; }; };
  if (kind == "isotropic")
    return always({});
  if (kind == "whole order")
    return always(cosine(whole_order));
  if (kind == "broken order")
    return always(cosine(random.uniform(0.3, 20)));
  if (kind == "narrow beams")
    return always(cosine(random.log_uniform(30, 300)));
  const Pattern table{Pattern::Kind::diagram, 0.0, random_diagram(random, random.flip())};
  if (kind == "measured")
    return always(table);
  return [&random, cosine, table]() -> Pattern { // mixed
    if (random.flip())
      return random.flip() ? Pattern{} : table;
    return cosine(random.uniform(1, 10));
  };
}

Illuminator random_light(Random &random, const Pose &world_from_camera, const Form &form,
                         const std::string &pattern, std::vector<std::string> &kinds) {
  const std::string layout = one_of<std::string, 5>(random, {"ring", "disc", "bar", "grid", "cluster"});
  const double reach_m = random.log_uniform(0.01, 0.5);
  const auto count = static_cast<std::uint32_t>(random.log_uniform(1, 2001));
  const bool tilted = random.flip(), unequal = random.flip();
  const NextPattern next_pattern = patterns_of(random, pattern, form.order);
  const Pose place{glm::dmat3(1.0), random.in_box(glm::dvec3(-0.2), glm::dvec3(0.2, 0.2, 0.1))};
  Illuminator light{layout, compose(world_from_camera, place), {}};
  for (const glm::dvec3 &place_m : places_m(random, layout, count, reach_m)) {
    Diode diode = diode_at(place_m);
    diode.axis = tilted ? tilted_axis(random, 0.5) : glm::dvec3(0.0, 0.0, 1.0);
    diode.across = glm::normalize(glm::cross(diode.axis, glm::dvec3(0.0, 1.0, 0.0)));
    diode.intensity_w_sr = unequal ? random.uniform(0.1, 2.0) : 1.0;
    diode.pattern = next_pattern();
    light.diodes.push_back(diode);
  }
  kinds.insert(kinds.end(), {layout, pattern, tilted ? "axes tilted" : "axes straight"});
  return light;
}

Surface two_sided_surface(Random &random) { return {random.uniform(0.1, 1.0), true}; }

void add_plane(Random &random, SceneBuilder &builder, const glm::dvec3 &centre_m, const glm::dvec3 &u_m,
               const glm::dvec3 &v_m) {
  builder.add_mesh({centre_m - u_m - v_m, centre_m - u_m + v_m, centre_m + u_m + v_m, centre_m + u_m - v_m},
                   {{0, 1, 2}, {0, 2, 3}}, two_sided_surface(random));
}

// The six sides of an upright box, seen from inside or outside.
void add_box(Random &random, SceneBuilder &builder, const glm::dvec3 &centre_m, const glm::dvec3 &half_m) {
  for (glm::length_t axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      glm::dvec3 out_m(0.0), u_m(0.0), v_m(0.0);
      out_m[axis] = side * half_m[axis];
      u_m[(axis + 1) % 3] = half_m[(axis + 1) % 3];
      v_m[(axis + 2) % 3] = half_m[(axis + 2) % 3];
      add_plane(random, builder, centre_m + out_m, u_m, v_m);
    }
}

// About the camera's frame; 0.5 to 30 m from the lens.
Scene random_scene(Random &random, const Pose &world_from_camera, std::vector<std::string> &kinds) {
  const std::string kind = one_of<std::string, 3>(random, {"wall", "room", "loose triangles"});
  kinds.push_back(kind);
  if (kind == "loose triangles")
    return random_triangles(random, 60, world_from_camera);
  SceneBuilder builder(world_from_camera);
  const double distance_m = random.log_uniform(0.6, 30.0);
  if (kind == "wall") {
    const double slant = random.uniform(-0.8, 0.8);
    add_plane(random, builder, {0.0, 0.0, distance_m}, 3.0 * distance_m * glm::dvec3(1.0, 0.0, slant),
              {0.0, 3.0 * distance_m, 0.0});
  } else {
    const double half_m = std::max(1.5, 0.5 * distance_m);
    add_box(random, builder, {0.05, 0.0, distance_m - half_m}, glm::dvec3(half_m));
    add_box(random, builder,
            distance_m * glm::dvec3(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.7),
            random.in_box(glm::dvec3(0.02), glm::dvec3(0.15)) * distance_m);
  }
  return builder.scene();
}

Sensor random_lens(Random &random, std::vector<std::string> &kinds) {
  Sensor sensor;
  if (random.uniform(0, 1) < 0.2) {
    do
      sensor = random_camera(random, coarsest);
    while (lens_fault(sensor));
  } else {
    sensor.resolution = coarsest;
    sensor.focal_length_m = 0.1;
    sensor.pixel_pitch_m = glm::dvec2(random.uniform(1.5e-3, 1e-2));
    if (random.uniform(0, 1) < 0.3)
      sensor.fill_factor = {random.uniform(0.3, 1), random.uniform(0.3, 1)};
  }
  kinds.push_back(sensor.has_distortion()    ? "distortion"
                  : sensor.chip.is_nominal() ? "pinhole"
                                             : "tilted chip");
  return sensor;
}

Sensor random_sensor(Random &random, const Form &form, std::vector<std::string> &kinds) {
  Sensor sensor = random_lens(random, kinds);
  sensor.world_from_camera = random.pose(30.0);
  sensor.samples = static_cast<std::uint32_t>(random.uniform(1, 5));
  sensor.adaptive_samples = sensor.samples > 1 && random.flip();
  sensor.waveform = form.waveform;
  sensor.modulation_hz.resize(form.frequencies);
  for (double &modulation_hz : sensor.modulation_hz)
    modulation_hz = random.log_uniform(1e6, 200e6);
  kinds.push_back(sensor.samples == 1 ? "S = 1" : sensor.adaptive_samples ? "S > 1, adaptive" : "S > 1");
  return sensor;
}

// As many pixels of the same view as are not too much to sum.
void refine(Sensor &sensor, std::size_t diodes) {
  const std::size_t paths_a_pixel = sensor.samples * sensor.samples * diodes * sensor.modulation_hz.size();
  const double side = std::sqrt(most_paths / static_cast<double>(paths_a_pixel));
  const glm::uvec2 resolution(glm::clamp(glm::dvec2(side), glm::dvec2(coarsest), glm::dvec2(32.0)));
  sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / glm::dvec2(resolution);
  sensor.resolution = resolution;
}

void add_kinds(const Form &form, std::vector<std::string> &kinds) {
  constexpr std::array waveforms{"sine", "square", "harmonics"};
  kinds.insert(kinds.end(), {waveforms[static_cast<std::size_t>(form.waveform.kind)],
                             form.patterns.size() == 2 ? "two illuminators" : "one illuminator",
                             form.phased ? "phased" : "not phased",
                             form.backscatter == Backscatter::lambert ? "lambert" : "constant",
                             form.shadows == Shadows::off ? "no shadows" : "shadows"});
}

} // namespace

RandomSetup random_setup(std::uint32_t seed) {
  const Form form = random_form(seed / seeds_of_a_form);
  Random random(seed);
  RandomSetup setup;
  setup.backscatter = form.backscatter;
  setup.shadows = form.shadows;
  setup.sensor = random_sensor(random, form, setup.kinds);
  setup.scene = random_scene(random, setup.sensor.world_from_camera, setup.kinds);
  for (const std::string &pattern : form.patterns)
    setup.illuminators.push_back(
        random_light(random, setup.sensor.world_from_camera, form, pattern, setup.kinds));
  if (form.phased)
    setup.illuminators.back().modulation_phase_rad = random.uniform(-2.0, 2.0);
  refine(setup.sensor, diode_count(setup.illuminators));
  setup.max_error_m = random.log_uniform(1e-6, 1e-2);
  add_kinds(form, setup.kinds);
  return setup;
}

} // namespace pmdsim::test
