// Images of surfaces with a formula come back as these surfaces.

#include "tests/correction/forward.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

const Pattern third_order{.kind = Pattern::Kind::cosine, .order = 3.0};

// An upright column of so many facets, about the point.
SurfaceFormula prism(const glm::dvec3 &centre_m, double radius_m, int facets) {
  return [=](const glm::dvec3 &ray) {
    Met met{0.0, -ray};
    double leaves_m = std::numeric_limits<double>::infinity();
    for (int k = 0; k < facets; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / facets;
      const glm::dvec3 normal(std::sin(angle), 0.0, std::cos(angle));
      const double range_m = (glm::dot(normal, centre_m) + radius_m) / glm::dot(normal, ray);
      if (glm::dot(normal, ray) > 0.0)
        leaves_m = std::min(leaves_m, range_m);
      else if (range_m > met.range_m)
        met = {range_m, normal};
    }
    return met.range_m < leaves_m ? met : Met{std::nan(""), -ray};
  };
}

} // namespace

TEST_CASE("one diode and one pixel: the ellipse has a closed form", "[smoke]") {
  // |P - D| + r = 2 d with P = r u, so r = (4 d^2 - D.D) / (4 d - 2 u.D).
  Sensor sensor = camera({32, 24}, 20.0);
  Illuminator lamp = ring(0.0, 1, {}, {0.3, -0.2, 0.1});
  const glm::dvec3 diode = lamp.diodes[0].position_m;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> distance_m(0.6, 7.0);
  MeasuredImage image;
  std::vector<double> range_m;
  for (std::uint32_t row = 0; row < 24; ++row)
    for (std::uint32_t column = 0; column < 32; ++column) {
      const double d = distance_m(random);
      const glm::dvec3 ray = ray_of(sensor, column, row);
      image.phase_rad.push_back(phase_of_distance_rad(d, sensor.modulation_hz[0]));
      range_m.push_back((4.0 * d * d - glm::dot(diode, diode)) / (4.0 * d - 2.0 * glm::dot(ray, diode)));
    }
  const CorrectedImage corrected =
      correct(sensor, {lamp}, image, {.backscatter = Backscatter::constant, .normals = NormalsFrom::facing});
  CHECK(count(corrected, PixelStatus::corrected) == range_m.size());
  CHECK(largest_error_m(corrected, range_m) < solved_m);
}

TEST_CASE("walls, square on and tilted, under a ring", "[smoke]") {
  const Sensor sensor = camera({48, 40}, 50.0);
  const std::vector<Illuminator> light{ring(0.15, 24, third_order)};
  for (const glm::dvec3 &normal : {glm::dvec3(0, 0, -1), glm::dvec3(0.5, 0.2, -1), glm::dvec3(0, 1.5, -1)}) {
    const Taken taken = take(sensor, light, wall({0, 0, 2}, normal));
    const CorrectedImage corrected = correct(sensor, light, taken.image, {});
    INFO("normal " << normal.x << ' ' << normal.y);
    CHECK(count(corrected, PixelStatus::corrected) == taken.range_m.size());
    CHECK(largest_error_m(corrected, taken.range_m) < solved_m);
    CHECK(glm::distance(corrected.normal[500], glm::normalize(normal)) < 1e-6);
  }
}

TEST_CASE("half a ring shines") {
  const Sensor sensor = camera({64, 64}, 400.0);
  Illuminator half = ring(0.146, 48, third_order);
  std::erase_if(half.diodes, [](const Diode &diode) { return diode.position_m.x < 0.0; });
  const Taken taken = take(sensor, {half}, wall({0, 0, 2}, {0.3, 0.1, -1}));
  const CorrectedImage corrected = correct(sensor, {half}, taken.image, {});
  CHECK(count(corrected, PixelStatus::corrected) == taken.range_m.size());
  CHECK(largest_error_m(corrected, taken.range_m) < solved_m);
}

TEST_CASE("a smooth sphere") {
  const Sensor sensor = camera({160, 160}, 500.0);
  const std::vector<Illuminator> light{ring(0.15, 24)};
  const Taken taken = take(sensor, light, ball({0.02, -0.03, 1.8}, 0.4));
  const CorrectedImage corrected = correct(sensor, light, taken.image, {});
  CHECK(count(corrected, PixelStatus::corrected) > taken.range_m.size() * 2 / 3);
  CHECK(largest_error_m(corrected, taken.range_m) < promised_m);
}

TEST_CASE("pixels with an area, on walls and on a sphere") {
  Sensor sensor = camera({100, 80}, 150.0);
  sensor.samples = 8;
  sensor.fill_factor = {0.9, 0.6};
  const std::vector<Illuminator> light{ring(0.1, 12)};
  for (const SurfaceFormula &surface : {wall({0, 0, 2}, {0.8, 0.3, -1}), ball({0, 0, 2.5}, 1.0)}) {
    const Taken taken = take(sensor, light, surface);
    const CorrectedImage corrected = correct(sensor, light, taken.image, {});
    CHECK(count(corrected, PixelStatus::corrected) > taken.range_m.size() / 2);
    CHECK(largest_error_m(corrected, taken.range_m) < promised_m);
    // Without the area the pixels of the same image are off by more.
    Sensor centres = sensor;
    centres.samples = 1;
    CHECK(largest_error_m(correct(centres, light, taken.image, {}), taken.range_m) > promised_m);
  }
}

TEST_CASE("square light and harmonics wiggle, and come back") {
  Sensor sensor = camera({40, 30}, 60.0);
  const std::vector<Illuminator> light{ring(0.15, 12)};
  for (const auto &[waveform, taps] :
       {std::pair(Waveform{Waveform::Kind::square, {}}, 4u),
        std::pair(Waveform{Waveform::Kind::square, {}}, 5u),
        std::pair(Waveform{Waveform::Kind::harmonics, {1.0, 0.2, 0.15, 0.0, 0.05}}, 4u)}) {
    sensor.waveform = waveform;
    sensor.taps = taps;
    const Taken taken = take(sensor, light, wall({0, 0, 3}, {1.0, 0.2, -1}));
    const CorrectedImage corrected = correct(sensor, light, taken.image, {});
    INFO(taps << " taps");
    CHECK(count(corrected, PixelStatus::corrected) == taken.range_m.size());
    CHECK(largest_error_m(corrected, taken.range_m) < solved_m);
  }
}

TEST_CASE("several illuminators with phases of their own, of different laws") {
  const Sensor sensor = camera({40, 30}, 60.0);
  std::vector<Illuminator> light{
      ring(0.1, 12, third_order),
      ring(0.05, 6, {.kind = Pattern::Kind::cosine, .order = 1.5}, {0.12, 0.05, 0.02})};
  light[1].modulation_phase_rad = 0.4;
  const Taken taken = take(sensor, light, wall({0, 0, 1.5}, {0.2, 0.3, -1}));
  const CorrectedImage corrected = correct(sensor, light, taken.image, {});
  CHECK(count(corrected, PixelStatus::corrected) == taken.range_m.size());
  CHECK(largest_error_m(corrected, taken.range_m) < promised_m);
}

TEST_CASE("lamps far apart, where a range depends on its normal more than points lie apart") {
  const Sensor sensor = camera({60, 50}, 80.0);
  std::vector<Illuminator> light{ring(0.05, 8), ring(0.0, 1, {}, {1.0, -0.4, 0.1})};
  light[1].modulation_phase_rad = 0.8;
  const Taken taken = take(sensor, light, wall({0, 0, 2}, {0.2, 0.3, -1}));
  const CorrectedImage corrected = correct(sensor, light, taken.image, {});
  CHECK(count(corrected, PixelStatus::corrected) > taken.range_m.size() * 19 / 20);
  CHECK(largest_error_m(corrected, taken.range_m) < promised_m);
}

TEST_CASE("a step: no plane reaches across it, and its pixels are marked") {
  const Sensor sensor = camera({80, 60}, 100.0);
  const std::vector<Illuminator> light{ring(0.15, 24)};
  const SurfaceFormula far = wall({0, 0, 2.5}, {0.2, 0, -1});
  const SurfaceFormula step = [far](const glm::dvec3 &ray) {
    return ray.x < 0.03 * ray.z ? wall({0, 0, 1.5}, {0.4, 0.3, -1})(ray) : far(ray);
  };
  const Taken taken = take(sensor, light, step);
  const CorrectedImage corrected = correct(sensor, light, taken.image, {});
  CHECK(count(corrected, PixelStatus::edge) >= 2 * 58);
  CHECK(count(corrected, PixelStatus::edge) < 4 * 60);
  CHECK(largest_error_m(corrected, taken.range_m) < solved_m);
  CHECK(largest_error_m(corrected, taken.range_m, PixelStatus::edge) < promised_m); // by planes of one side
}

TEST_CASE("mixed pixels of an edge are marked") {
  Sensor sensor = camera({60, 60}, 100.0);
  sensor.samples = 4;
  const std::vector<Illuminator> light{ring(0.05, 8)};
  const Taken taken = take(sensor, light, both(ball({0, 0, 1.5}, 0.3), wall({0, 0, 2.5}, {0, 0, -1})));
  const CorrectedImage corrected = correct(sensor, light, taken.image, {});
  CHECK(count(corrected, PixelStatus::corrected) > 60 * 60 / 2);
  CHECK(count(corrected, PixelStatus::edge) > 100);
  CHECK(largest_error_m(corrected, taken.range_m) < promised_m);
}

TEST_CASE("facets of about a pixel: a plane that fits by chance is marked") {
  Sensor sensor = camera({80, 60}, 266.7);
  sensor.samples = 2;
  const std::vector<Illuminator> light{ring(0.05, 8, {}, {-0.2, 0.0, 0.0})};
  for (const int facets : {36, 48, 60, 72}) {
    const SurfaceFormula surface = both(prism({0, 0, 2.5}, 0.12, facets), wall({0, 0, 3}, {0.2, 0.1, -1}));
    const Taken taken = take(sensor, light, surface);
    const CorrectedImage corrected = correct(sensor, light, taken.image, {});
    INFO(facets << " facets");
    CHECK(count(corrected, PixelStatus::corrected) > taken.range_m.size() / 2); // the wall
    CHECK(largest_error_m(corrected, taken.range_m) < promised_m);
  }
}
