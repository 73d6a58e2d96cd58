#include "host/bench/sweep.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace pmdsim {
namespace {

// In the order of SweptQuantity.
const std::array<SweptRow, 5> swept_rows{{{"resolution", "pixels", true, {160, 320, 640, 1280, 2560, 4096}},
                                          {"diodes", "diodes", false, {1, 4, 16, 60, 240, 960, 3840, 24000}},
                                          {"samples", "samples a pixel", true, {1, 2, 4, 8}},
                                          {"triangles", "triangles", false, {2, 200, 20000, 1000000}},
                                          {"frequencies", "frequencies", false, {1, 2, 4, 8}}}};

constexpr std::uint32_t paper_columns = 640, paper_diodes = 240;
constexpr double paper_pitch_m = 45e-6;

// About the lens, in as many of the paper's rings as share them evenly.
Illuminator ring_light(std::uint32_t diodes) {
  const std::uint32_t rings = diodes % 5 == 0 ? 5 : 1, count = diodes / rings;
  Illuminator light;
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const double radius_m = rings == 1 ? 0.146 : 0.126 + 0.010 * ring;
    for (std::uint32_t k = 0; k < count; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.5) / count;
      Diode diode;
      diode.position_m = {radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0};
      light.diodes.push_back(diode);
    }
  }
  return light;
}

Scene wall(std::uint32_t triangles) {
  const std::uint32_t cells = triangles / 2;
  std::uint32_t rows = static_cast<std::uint32_t>(std::sqrt(cells));
  while (cells % rows != 0)
    --rows;
  const std::uint32_t columns = cells / rows;
  Scene scene;
  scene.surfaces.resize(1);
  scene.objects = {"wall"};
  for (std::uint32_t y = 0; y <= rows; ++y)
    for (std::uint32_t x = 0; x <= columns; ++x)
      scene.positions_m.emplace_back(0.4 * x / columns - 0.2, 0.4 * y / rows - 0.2, -2.0);
  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t corner = y * (columns + 1) + x, above = corner + columns + 1;
      scene.triangles.push_back({{corner, corner + 1, above + 1}, 0, 0});
      scene.triangles.push_back({{corner, above + 1, above}, 0, 0});
    }
  return scene;
}

} // namespace

const SweptRow &row_of(SweptQuantity quantity) { return swept_rows[static_cast<std::size_t>(quantity)]; }

std::string SweepPoint::name() const { return fmt::format("{} {}", row_of(quantity).name, value); }

double SweepPoint::units() const {
  const double n = value;
  return row_of(quantity).squared ? n * n : n;
}

std::vector<std::vector<SweepPoint>> all_sweeps() {
  std::vector<std::vector<SweepPoint>> sweeps;
  for (std::size_t i = 0; i < swept_rows.size(); ++i) {
    std::vector<SweepPoint> &points = sweeps.emplace_back();
    for (const std::uint32_t value : swept_rows[i].values)
      points.push_back({static_cast<SweptQuantity>(i), value});
  }
  return sweeps;
}

Setup paper_ring() {
  Setup setup;
  setup.backscatter = Backscatter::constant;
  setup.start = {wall(2), {Sensor()}, {ring_light(paper_diodes)}};
  return setup;
}

Setup swept_setup(const SweepPoint &point) {
  Setup setup = paper_ring();
  Sensor &sensor = setup.start.sensors.front();
  switch (point.quantity) {
  case SweptQuantity::resolution:
    sensor.resolution = glm::uvec2(point.value);
    sensor.pixel_pitch_m = glm::dvec2(paper_pitch_m * paper_columns / point.value);
    break;
  case SweptQuantity::diodes:
    setup.start.illuminators = {ring_light(point.value)};
    break;
  case SweptQuantity::samples:
    sensor.samples = point.value;
    break;
  case SweptQuantity::triangles:
    setup.start.scene = wall(point.value);
    break;
  case SweptQuantity::frequencies:
    for (std::uint32_t i = 1; i < point.value; ++i)
      sensor.modulation_hz.push_back(sensor.modulation_hz.front() + 2.5e6 * i);
    break;
  }
  return setup;
}

} // namespace pmdsim
