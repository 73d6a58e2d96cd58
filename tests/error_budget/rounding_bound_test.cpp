#include "engine/error_budget/rounding_bound.h"
#include "tests/error_budget/least_incidence.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>

using namespace pmdsim;

namespace {

constexpr double float_rounding = 0x1p-24;
constexpr double signal_wavenumber_rad_m = 2.0 * std::numbers::pi * 20e6 / 299792458.0;
const std::vector<VisibleBox> point_at_2m{{{0.0, 0.0, 2.0}, {0.0, 0.0, 2.0}}};

struct Light {
  std::vector<CameraIlluminator> illuminators;
  std::vector<VisibleBox> visible = point_at_2m;
  std::vector<double> modulation_hz{20e6};
  Waveform waveform{};
  std::uint32_t backscatter = shader::backscatter_flat;
  std::uint32_t taps = 4;
};

std::vector<CameraIlluminator> diodes_at(const std::vector<glm::dvec3> &places_m,
                                         const Pattern &pattern = {}) {
  CameraIlluminator illuminator;
  for (const glm::dvec3 &place_m : places_m) {
    illuminator.diodes.emplace_back().position_m = place_m;
    illuminator.diodes.back().pattern = pattern;
  }
  return {illuminator};
}

const Waveform third_harmonic{Waveform::Kind::harmonics, {1.0, 0.0, 0.1}}; // 4 taps take it for the first

const std::vector<glm::dvec3> pair{{-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}};

std::optional<RoundingBound> bound_of(const Light &light, const RoundingScope &scope = {}) {
  Sensor sensor;
  sensor.modulation_hz = light.modulation_hz;
  sensor.waveform = light.waveform;
  sensor.taps = light.taps;
  const Modulation signal = modulation_of(sensor, {});
  const SourceGroups groups =
      group_diodes(light.illuminators, light.visible, signal.largest_wavenumber_rad_m(), scope.precision);
  SumModel model = sum_model(light.illuminators, Backscatter::constant, true);
  model.backscatter = light.backscatter;
  return rounding_bound(groups, light.visible, model, signal, scope);
}

} // namespace

TEST_CASE("light in the lens is rounded at the output only") {
  const RoundingBound bound = bound_of({diodes_at({{0.0, 0.0, 0.0}})}).value();
  CHECK(bound.output_m == Approx(float_rounding * 2.0));
  CHECK(bound.fixed_m == Approx(0x1p-38 * 2.0));
  CHECK(bound.per_condition_m == 0.0); // whatever its weight is off by, there is one path
  CHECK(bound.per_weight_m == 0.0);
  CHECK(bound.amplitude_fixed == Approx(25 * float_rounding));
  CHECK(bound.amplitude_per_condition ==
        Approx(26 * float_rounding)); // 23 the weight, 3 Horner; one diode is no sum
}

TEST_CASE("a pair of diodes by hand") {
  // R = 0.1, t = 0.05, |e| <= 0.01 / 3.9; weights off by 28 u over paths 3 e apart, e by 0.725 u.
  // K = 3: the moments left out are 0.008 u of it.
  const RoundingBound bound = bound_of({diodes_at(pair)}).value();
  CHECK(bound.weight_error == Approx(28.01 * float_rounding).epsilon(1e-3));
  CHECK(bound.per_condition_m == Approx(0.5 * float_rounding * 0.725).epsilon(1e-3));
  CHECK(bound.any_weight_m == Approx(0.5 / signal_wavenumber_rad_m));
  CHECK(bound.per_weight_m == Approx(0.5 * 3 * 0.01 / 3.9).epsilon(1e-3));
  CHECK(bound.even_part == Approx(1.0 / 3.0)); // all weights off alike: e, not 3 e
  CHECK(bound.amplitude_per_weight == 1.0);
  const double angle_m = 0.5 * 6 * float_rounding * 0.01 / 3.9;
  CHECK(bound.output_m == Approx(float_rounding * (2.0 + 0.01 / 3.9)).epsilon(1e-3));
  CHECK(bound.fixed_m == Approx(angle_m + 0x1p-38 * 2.0).epsilon(1e-3));
}

TEST_CASE("weights that are off turn a sum the less, the less its terms cancel") {
  std::vector<CameraIlluminator> lights = diodes_at({{-0.1, 0.0, 0.0}});
  lights.push_back(diodes_at({{0.1, 0.0, 0.0}}).front());
  lights.back().modulation_phase_rad = 1.0;
  const RoundingBound bound = bound_of({lights}).value();
  CHECK(bound.distance_m_at(1.0) < 0.5 * bound.distance_m(1.0));
  CHECK(bound.distance_m_at(1.0) > bound.output_m + bound.fixed_m + bound.per_condition_m);
  CHECK(bound.distance_m_at(3.0) == Approx(bound.distance_m(3.0)).epsilon(0.1));
  RoundingBound unknown = bound;
  unknown.any_weight_m = std::numeric_limits<double>::infinity();
  CHECK(unknown.distance_m_at(1.0) == Approx(bound.distance_m(1.0)).epsilon(1e-12));
}

TEST_CASE("in double only the output is rounded") {
  const RoundingBound in_float = bound_of({diodes_at(pair)}).value();
  const RoundingBound in_double = bound_of({diodes_at(pair)}, {.precision = Precision::fp64}).value();
  CHECK(in_double.fixed_m < in_float.fixed_m); // by the sum's own angle
  CHECK(in_double.output_m == in_float.output_m);
  CHECK(in_double.fixed_m == Approx(0x1p-38 * 2.0).epsilon(1e-3));
  CHECK(in_double.per_condition_m < 1e-5 * in_float.per_condition_m);
  CHECK(in_double.amplitude_per_condition < 1e-5 * in_float.amplitude_per_condition);
}

TEST_CASE("distances from a low frequency are off by half a unit in the last place of a float, in double") {
  auto lights = diodes_at(pair);
  lights[0].modulation_phase_rad = 1.0;
  const Light far{lights, point_at_2m, {1e6}};
  CHECK(bound_of(far, {.precision = Precision::fp64})->output_m == Approx(0x1p-24 * 128.0).epsilon(1e-4));
  CHECK(bound_of(far)->distance_m(1.0) > 10e-6);
}

TEST_CASE("what makes weights worse makes the bound larger") {
  const double isotropic = bound_of({diodes_at(pair)})->weight_error;
  double before = isotropic;
  for (const double order : {2.0, 7.5, 100.0}) {
    const Light beams{diodes_at(pair, {Pattern::Kind::cosine, order})};
    const double now = bound_of(beams, {.emission_cosine = 0.9})->weight_error;
    CHECK(now > before);
    before = now;
  }
  Light lambert{diodes_at(pair)};
  lambert.backscatter = shader::backscatter_lambert;
  before = isotropic;
  for (const double cosine : {1.0, 0.1, 0.01}) {
    const double now = bound_of(lambert, {.incidence_cosine = cosine})->weight_error;
    CHECK(now > before);
    before = now;
  }
}

TEST_CASE("within beams the error grows as they dim, where pixels know how dim they are") {
  const Light beams{diodes_at(pair, {Pattern::Kind::cosine, 100.0})};
  RoundingScope scope{.emission_cosine = 0.8};
  const RoundingBound any = bound_of(beams, scope).value();
  scope.beams_are_terms = true;
  const RoundingBound bright = bound_of(beams, scope).value();
  CHECK(any.beams.at(10.0) == 0.0);
  CHECK(bright.weight_error < 0.1 * any.weight_error);
  const double dimmest = -100.0 * std::log(0.8);
  double before_m = bright.distance_m(1.0);
  for (const double dimming : {1.0, 4.0, 16.0, dimmest}) {
    const double now_m = bright.distance_m(1.0, dimming);
    CHECK(now_m > before_m);
    CHECK(bright.distance_m_at(1.0, dimming) <= now_m * (1 + 1e-12));
    CHECK(bright.amplitude(1.0, dimming) == Approx(bright.amplitude(1.0) + bright.beams.at(dimming)));
    before_m = now_m;
  }
  // No even part, and a square that is simplified.
  CHECK(bright.weight_error + bright.beams.at(dimmest) >= any.weight_error);
  CHECK(bright.weight_error + bright.beams.at(dimmest) <= 1.5 * any.weight_error);
  const Light mild{diodes_at(pair, {Pattern::Kind::cosine, 3.0})};
  CHECK(bound_of(mild, scope)->beams.at(10.0) == 0.0);
}

TEST_CASE("samples of one pixel at different ranges") {
  const Light room{diodes_at(pair), {{{-1.0, -1.0, 1.0}, {1.0, 1.0, 4.0}}}};
  const double any_m = bound_of(room, {.samples = 4})->distance_m(1.0);
  const double smooth_m = bound_of(room, {.samples = 4, .sample_spread_m = 0.001})->distance_m(1.0);
  CHECK(any_m > smooth_m);
  CHECK(smooth_m > bound_of(room)->distance_m(1.0));
}

TEST_CASE("what is known of samples at one range grows evenly as they part, at most") {
  const Light room{diodes_at(pair), {{{-1.0, -1.0, 1.0}, {1.0, 1.0, 4.0}}}};
  for (const Waveform &waveform : {Waveform{}, Waveform{Waveform::Kind::square, {}}, third_harmonic}) {
    Light light = room;
    light.waveform = waveform;
    const auto apart = [&](double spread_m) {
      return bound_of(light, {.samples = 4, .sample_spread_m = spread_m}).value();
    };
    const RoundingBound near = apart(0.0);
    for (const double spread_m : {0.001, 0.1, 1.0, 3.0}) {
      const RoundingBound far = apart(spread_m);
      const double per_apart_m = (near.per_apart + near.weight_error * near.amplitude_per_weight) * spread_m;
      CHECK(far.distance_m(1.0) <= (near.distance_m(1.0) + per_apart_m) * (1 + 1e-12)); // or the same
      CHECK(far.distance_m(1.0) >= near.distance_m(1.0) + 0.5 * std::min(per_apart_m, 1e-8));
      CHECK(far.per_weight_m <= near.per_weight_m + near.amplitude_per_weight * spread_m * (1 + 1e-12));
    }
  }
}

TEST_CASE("errors of weights turn harmonics by their slope at most") {
  Light light{diodes_at(pair)};
  const RoundingBound sine = bound_of(light).value();
  light.waveform = third_harmonic;
  const RoundingBound harmonics = bound_of(light).value();
  CHECK(harmonics.per_weight_m == Approx((1.0 + 3 * 0.1) / 1.1 * sine.per_weight_m));
  CHECK(harmonics.weight_error == Approx(sine.weight_error).epsilon(0.05));
  // Each harmonic is turned by itself: 10 u of a phase, 3 u of its amplitude and in the sum, 3 u of the
  // weights.
  const double turned_m = 0.5 * float_rounding / signal_wavenumber_rad_m * (10 + 3 + 3);
  CHECK(harmonics.per_condition_m - sine.per_condition_m == Approx(turned_m).epsilon(0.1));
  // The second is not seen by four taps.
  light.waveform.harmonics = {1.0, 5.0};
  CHECK(bound_of(light)->per_weight_m == Approx(sine.per_weight_m));
  light.waveform.harmonics = {0.0, 5.0};
  CHECK(bound_of(light)->per_weight_m == 0.0);
}

TEST_CASE("weights that are off turn random harmonics within the bound") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  double nearest = 0.0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    std::vector<glm::dvec3> places_m(6);
    for (glm::dvec3 &place_m : places_m)
      place_m = {0.4 * any(random), 0.4 * any(random), 0.4 * any(random)};
    Light light{diodes_at(places_m)};
    light.waveform = {Waveform::Kind::harmonics,
                      {any(random), any(random), any(random), any(random), any(random)}};
    light.taps = 3 + i % 3;
    std::complex<double> z, off;
    double terms = 0.0;
    for (const glm::dvec3 &place_m : places_m) {
      const double phase_rad =
          signal_wavenumber_rad_m * (2.0 + glm::distance(place_m, glm::dvec3(0.0, 0.0, 2.0)));
      const double weight = 1.0 + any(random), sign = any(random) > 0.0 ? 1.0 : -1.0;
      for (std::uint32_t h = 1; h <= light.waveform.harmonics.size(); ++h) {
        const bool shows = h % light.taps == 1, is_mirrored = h % light.taps == light.taps - 1;
        if (!shows && !is_mirrored)
          continue;
        const auto term =
            weight * light.waveform.harmonics[h - 1] * std::polar(1.0, (shows ? 1.0 : -1.0) * h * phase_rad);
        z += term;
        off += sign * term;
        terms += std::abs(term);
      }
    }
    const double turned_m = 0.5 * std::abs((off / z).imag()) / signal_wavenumber_rad_m;
    const double bound_m = bound_of(light)->per_weight_m * terms / std::abs(z);
    REQUIRE(turned_m <= bound_m);
    nearest = std::max(nearest, turned_m / bound_m);
  }
  CHECK(nearest > 0.3); // a third of the bound would not do
}

TEST_CASE("samples of one pixel at one range, apart across the view of a lamp beside the lens") {
  // All are 2 m from the lens, but of a pixel of 0.2 rad some are 0.4 m nearer to the lamp than others.
  const Light beside{diodes_at({{3.0, 0.0, 0.0}, {3.001, 0.0, 0.0}})};
  const auto of_pixel_m = [&](double pixel_rad) {
    return bound_of(beside, {.samples = 4, .sample_spread_m = 0.0, .pixel_rad = pixel_rad})->per_weight_m;
  };
  CHECK(of_pixel_m(0.2) - of_pixel_m(0.0) == Approx(0.5 * 0.4));
  // Where the pixel's angle is not known, the lamp's distance from the lens bounds the error.
  CHECK(of_pixel_m(std::numeric_limits<double>::infinity()) > of_pixel_m(0.2));
}

TEST_CASE("the worst of several frequencies, and lights that differ in phase") {
  const RoundingBound slow = bound_of({diodes_at(pair), point_at_2m, {1e6}}).value();
  const RoundingBound fast = bound_of({diodes_at(pair), point_at_2m, {20e6}}).value();
  const RoundingBound both = bound_of({diodes_at(pair), point_at_2m, {1e6, 20e6}}).value();
  CHECK(both.fixed_m >= std::max(slow.fixed_m, fast.fixed_m));
  CHECK(both.per_condition_m >= std::max(slow.per_condition_m, fast.per_condition_m) * (1 - 1e-6));

  std::vector<CameraIlluminator> lights{diodes_at({pair[0]})[0], diodes_at({pair[1]})[0]};
  const double alike_m = bound_of({lights})->per_weight_m;
  CHECK(bound_of({lights})->even_part == Approx(0.5)); // two runs of a diode each, exactly in their places
  lights[1].modulation_phase_rad = std::numbers::pi;
  CHECK(bound_of({lights})->per_weight_m > 10.0 * alike_m);
  CHECK(bound_of({lights})->even_part == 1.0);
  CHECK(bound_of({lights})->per_weight_m == Approx(bound_of({lights})->any_weight_m));
}

TEST_CASE("waveforms have a bound, and diagrams that are not infinitely steep") {
  for (const Waveform &waveform :
       {Waveform{Waveform::Kind::square, {}}, Waveform{Waveform::Kind::harmonics, {1.0, 0.0, -0.1}}}) {
    const RoundingBound bound = bound_of({diodes_at(pair), point_at_2m, {20e6}, waveform}).value();
    CHECK(bound.distance_m(1.0) > bound_of({diodes_at(pair)})->distance_m(1.0));
    CHECK(bound.distance_m(1.0) < 100e-6);
    CHECK_FALSE(std::isfinite(bound.any_weight_m));
  }
  const auto table = std::make_shared<const Diagram>(Diagram{{0.0, 1.0}, {0.0}, {1.0, 0.5}});
  CHECK(bound_of({diodes_at(pair, {Pattern::Kind::diagram, 0.0, table})}));
  const auto about_axis =
      std::make_shared<const Diagram>(Diagram{{0.0, 1.0}, {0.0, 3.0}, {1.0, 0.9, 0.5, 0.5}});
  CHECK_FALSE(bound_of({diodes_at(pair, {Pattern::Kind::diagram, 0.0, about_axis})}));
}

TEST_CASE("least cosines of a wall") {
  // 45 degrees off the axis at the box's corners; from the diodes' box a little less.
  const std::vector<VisibleBox> wall{{{-2.0, 0.0, 2.0}, {2.0, 0.0, 2.0}}};
  const auto lights = diodes_at(pair, {Pattern::Kind::cosine, 1.0});
  const SourceGroups groups = group_diodes(lights, wall, 0.4);
  CHECK(least_emission_cosine(groups, wall) == Approx(2.0 / std::hypot(2.0, 2.1)));
  CameraScene camera;
  camera.triangles.push_back({{glm::dvec3{-2, 0, 2}, {2, 0, 2}, {0, 1, 2}}, 0});
  camera.planes.push_back({{0.0, 0.0, -1.0}, -2.0});
  CHECK(test::least_incidence_cosine(camera, groups, wall) == Approx(2.0 / std::hypot(2.0, 2.1)));
  // A plane between the diodes.
  camera.triangles.push_back({{glm::dvec3{0, 0, 1}, {0, 0, 2}, {0, 1, 2}}, 1});
  camera.planes.push_back({{-1.0, 0.0, 0.0}, 0.0});
  CHECK(test::least_incidence_cosine(camera, groups, wall) == grazing_cosine);
}
