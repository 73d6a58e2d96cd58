// The room that a newcomer sees first.
#include "host/shapes/mesh.h"
#include "host/start/kinds.h"

#include <glm/gtc/constants.hpp>
#include <utility>

namespace pmdsim {
namespace {

constexpr double floor_m = 0.0, back_m = -4.0, left_m = -2.4;

// Two walls and a floor that fill the view.
void add_shell(Mesh &mesh) {
  mesh.begin("floor", 0.35);
  mesh.sheet(1, 1, [](double u, double v) { return glm::dvec3(0.6 + 3.0 * u, floor_m, -1.75 - 2.25 * v); });
  mesh.begin("back_wall", 0.8);
  mesh.sheet(1, 1, [](double u, double v) { return glm::dvec3(0.6 + 3.0 * u, 1.5 + 1.5 * v, back_m); });
  mesh.begin("left_wall", 0.7);
  mesh.sheet(1, 1, [](double u, double v) { return glm::dvec3(left_m, 1.5 + 1.5 * v, -1.75 - 2.25 * u); });
}

// A top on four legs.
void add_table(Mesh &mesh) {
  const glm::dvec3 middle_m(0.55, 0.0, -2.3);
  constexpr double height_m = 0.72;
  mesh.begin("table", 0.5);
  mesh.box(middle_m + glm::dvec3(0.0, height_m - 0.02, 0.0), glm::dvec3(0.6, 0.02, 0.35));
  for (const double x : {-0.54, 0.54})
    for (const double z : {-0.29, 0.29})
      mesh.box(middle_m + glm::dvec3(x, 0.5 * (height_m - 0.04), z),
               glm::dvec3(0.025, 0.5 * (height_m - 0.04), 0.025));
  constexpr double radius_m = 0.16;
  mesh.begin("ball", 0.75);
  mesh.sphere(middle_m + glm::dvec3(-0.2, height_m + radius_m, 0.05), radius_m, 24);
}

void add_bodies(Mesh &mesh) {
  const double turn_rad = glm::radians(25.0);
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  mesh.begin("crate", 0.6);
  mesh.box({-0.75, 0.3, -2.0}, 0.3 * glm::dmat3(c, 0, -s, 0, 1, 0, s, 0, c));
  mesh.begin("column", 0.65);
  mesh.rod({-1.35, floor_m, -3.0}, {-1.35, 2.6, -3.0}, 0.16, 0.16, 64);
  mesh.begin("cabinet", 0.15); // dark: distances are as well as those of light bodies, amplitudes low
  mesh.box({1.75, 0.8, -3.6}, glm::dvec3(0.45, 0.8, 0.3));
}

} // namespace

StartScene room_scene(const StartSizes & /*sizes*/) {
  Mesh mesh;
  add_shell(mesh);
  add_table(mesh);
  add_bodies(mesh);
  // A little down.
  return {.scene = std::move(mesh).scene(),
          .camera_m = {0.0, 1.3, 0.4},
          .world_from_camera = glm::angleAxis(glm::radians(-8.0), glm::dvec3(1.0, 0.0, 0.0))};
}

} // namespace pmdsim
