#include "tests/bench/hills.h"

#include <cmath>
#include <numbers>

namespace pmdsim::bench {
namespace {

constexpr std::uint32_t squares = 708; // along each side of the floor: a million triangles

// A sheet of squares, `columns` by `rows`; `place` takes fractions of the sheet.
template <typename Place>
void add_sheet(Scene &scene, std::uint32_t columns, std::uint32_t rows, const Place &place) {
  const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  for (std::uint32_t v = 0; v <= rows; ++v)
    for (std::uint32_t u = 0; u <= columns; ++u)
      scene.positions_m.push_back(place(double(u) / columns, double(v) / rows));
  for (std::uint32_t v = 0; v < rows; ++v)
    for (std::uint32_t u = 0; u < columns; ++u) {
      const std::uint32_t at = first + v * (columns + 1) + u, above = at + columns + 1;
      scene.triangles.push_back({{at, at + 1, above + 1}, 0, object});
      scene.triangles.push_back({{at, above + 1, above}, 0, object});
    }
  scene.objects.push_back("sheet " + std::to_string(object));
}

double hill_m(double x, double z) {
  return 0.1 * std::sin(2.1 * x + 0.3) * std::cos(2.7 * z) + 0.06 * std::sin(6.1 * x - 1.3 * z);
}

void add_ball(Scene &scene, const glm::dvec3 &centre_m, double radius_m) {
  add_sheet(scene, 48, 24, [&](double u, double v) {
    const double around = 2.0 * std::numbers::pi * u, up = std::numbers::pi * (v - 0.5);
    return centre_m + radius_m * glm::dvec3(std::cos(up) * std::sin(around), std::sin(up),
                                            std::cos(up) * std::cos(around));
  });
}

} // namespace

Scene hills() {
  Scene scene;
  scene.surfaces.emplace_back();
  add_sheet(scene, squares, squares, [](double u, double v) {
    const double x = 9.0 * (u - 0.5), z = -1.0 - 6.0 * v;
    return glm::dvec3(x, -0.9 + hill_m(x, z), z);
  });
  add_sheet(scene, 1, 1,
            [](double u, double v) { return glm::dvec3(12.0 * (u - 0.5), 12.0 * (v - 0.5), -7.0); });
  for (int i = 0; i < 8; ++i)
    add_ball(scene, {0.5 * (i - 3.5), -0.5 + 0.13 * (i % 3), -2.0 - 0.9 * (i % 4)}, 0.12 + 0.02 * (i % 5));
  return scene;
}

} // namespace pmdsim::bench
