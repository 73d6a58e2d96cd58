// The cost of light that bounces: each pass of a first frame, and what is claimed of its error. Not a test:
// times are reported, never asserted. Scenes may be named to measure only these.

#include "engine/simulator.h"
#include "host/input/setup/setup.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

using namespace pmdsim;

namespace {

struct View {
  Scene scene;
  Sensor sensor;
  std::vector<Illuminator> illuminators;
};

using Quad = std::array<glm::dvec3, 4>;

void add_quad(Scene &scene, const Quad &corners, double reflectivity) {
  const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
  scene.positions_m.insert(scene.positions_m.end(), corners.begin(), corners.end());
  const auto surface = static_cast<std::uint32_t>(scene.surfaces.size());
  scene.surfaces.push_back({reflectivity, false, std::nullopt});
  scene.objects.emplace_back("quad");
  for (const std::array<std::uint32_t, 3> face : {std::array{0u, 1u, 2u}, std::array{0u, 2u, 3u}})
    scene.triangles.push_back({{first + face[0], first + face[1], first + face[2]}, surface, surface});
}

// The faces of a box, turned about the vertical axis, their fronts outside, or inside.
void add_box(Scene &scene, const glm::dvec3 &centre, const glm::dvec3 &half, double turn_rad,
             double reflectivity, bool inside, bool open_front = false) {
  const auto place = [&](double x, double y, double z) {
    const glm::dvec3 p = glm::dvec3(x, y, z) * half;
    return centre + glm::dvec3(std::cos(turn_rad) * p.x + std::sin(turn_rad) * p.z, p.y,
                               std::cos(turn_rad) * p.z - std::sin(turn_rad) * p.x);
  };
  const std::vector<Quad> faces{{place(-1, -1, 1), place(1, -1, 1), place(1, 1, 1), place(-1, 1, 1)},
                                {place(1, -1, -1), place(-1, -1, -1), place(-1, 1, -1), place(1, 1, -1)},
                                {place(1, -1, 1), place(1, -1, -1), place(1, 1, -1), place(1, 1, 1)},
                                {place(-1, -1, -1), place(-1, -1, 1), place(-1, 1, 1), place(-1, 1, -1)},
                                {place(-1, 1, 1), place(1, 1, 1), place(1, 1, -1), place(-1, 1, -1)},
                                {place(-1, -1, -1), place(1, -1, -1), place(1, -1, 1), place(-1, -1, 1)}};
  for (Quad face : faces) {
    if (&face != &faces[0] && inside)
      std::ranges::reverse(face);
    add_quad(scene, face, reflectivity);
  }
  if (inside) { // the face at +z is the front, where the camera looks in
    if (open_front) {
      scene.triangles.erase(scene.triangles.end() - 12, scene.triangles.end() - 10);
    }
  }
}

std::vector<Illuminator> ring(std::size_t count, double order, double radius_m) {
  Illuminator light;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    light.diodes.push_back({{radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0},
                            {0, 0, 1},
                            1.0,
                            {Pattern::Kind::cosine, order}});
  }
  return {light};
}

// A box of 1 m without its front, with two blocks, seen from 1.2 m before its middle.
View blocks() {
  View view;
  add_box(view.scene, {0, 0, -1.7}, {0.5, 0.5, 0.5}, 0.0, 0.7, true, true);
  add_box(view.scene, {-0.18, -0.2, -1.85}, {0.14, 0.3, 0.14}, 0.3, 0.6, false);
  add_box(view.scene, {0.2, -0.35, -1.5}, {0.15, 0.15, 0.15}, -0.3, 0.8, false);
  view.sensor.resolution = {320, 200};
  view.sensor.pixel_pitch_m = {1e-5, 1e-5};
  view.sensor.focal_length_m = 3e-3;
  view.illuminators = ring(48, 3.0, 0.03);
  return view;
}

View sphere(std::uint32_t rings) {
  View view;
  Scene &scene = view.scene;
  scene.surfaces.push_back({0.8, false, std::nullopt});
  scene.objects.emplace_back("sphere");
  const std::uint32_t columns = 2 * rings;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double t = std::numbers::pi * i / rings, p = 2.0 * std::numbers::pi * j / columns;
      scene.positions_m.push_back(
          2.0 * glm::dvec3(std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p)));
    }
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns, c = a + columns,
                          d = b + columns;
      if (i > 0)
        scene.triangles.push_back({{a, b, c}, 0, 0});
      if (i + 1 < rings)
        scene.triangles.push_back({{b, d, c}, 0, 0});
    }
  for (Triangle &triangle : scene.triangles) { // their fronts inside
    const auto corner = [&](std::size_t k) { return scene.positions_m[triangle.vertices[k]]; };
    if (glm::dot(glm::cross(corner(1) - corner(0), corner(2) - corner(0)), corner(0)) > 0.0)
      std::swap(triangle.vertices[1], triangle.vertices[2]);
  }
  view.sensor.resolution = {64, 40};
  view.sensor.pixel_pitch_m = {5e-5, 5e-5};
  view.sensor.focal_length_m = 3e-3;
  Illuminator light;
  light.diodes.push_back({});
  view.illuminators = {light};
  return view;
}

// A closed room of 3 x 2.5 x 4 m with a block and a ball of that many triangles, which is not quite round.
View mesh(std::uint32_t triangles) {
  View view;
  Scene &scene = view.scene;
  add_box(scene, {0, 0, -1.5}, {1.5, 1.25, 2.0}, 0.0, 0.6, true);
  add_box(scene, {-0.7, -0.9, -2.4}, {0.3, 0.35, 0.3}, 0.4, 0.5, false);
  const auto surface = static_cast<std::uint32_t>(scene.surfaces.size());
  scene.surfaces.push_back({0.7, false, std::nullopt});
  scene.objects.emplace_back("ball");
  const auto rings = static_cast<std::uint32_t>(std::sqrt(triangles / 4.0)), columns = 2 * rings;
  const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double t = std::numbers::pi * i / rings, p = 2.0 * std::numbers::pi * j / columns;
      const double radius_m = 0.5 + 0.05 * std::sin(3.0 * t) * std::cos(5.0 * p);
      scene.positions_m.push_back(
          glm::dvec3(0.4, -0.5, -2.0) +
          radius_m * glm::dvec3(std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p)));
    }
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t a = first + i * columns + j, b = first + i * columns + (j + 1) % columns,
                          c = a + columns, d = b + columns;
      if (i > 0)
        scene.triangles.push_back({{a, b, c}, surface, surface});
      if (i + 1 < rings)
        scene.triangles.push_back({{b, d, c}, surface, surface});
    }
  view.sensor.resolution = {320, 240};
  view.sensor.pixel_pitch_m = {1e-5, 1e-5};
  view.sensor.focal_length_m = 2.6e-3;
  view.illuminators = ring(48, 1.0, 0.05);
  return view;
}

View shipped(const std::string &file) {
  const Setup setup = load_setup(file);
  return {setup.start.scene, setup.start.sensors[0], setup.start.illuminators};
}

View view_of(const std::string &name) {
  if (name == "blocks")
    return blocks();
  if (name.starts_with("sphere"))
    return sphere(static_cast<std::uint32_t>(std::stoul(name.substr(6))));
  if (name.starts_with("mesh"))
    return mesh(static_cast<std::uint32_t>(std::stoul(name.substr(4))));
  return shipped(name);
}

double median(std::vector<float> values) {
  std::erase_if(values, [](float value) { return std::isnan(value); });
  if (values.empty())
    return 0;
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return static_cast<double>(values[values.size() / 2]);
}

} // namespace

// How far multipath_m is off in a coarse frame, beside a frame that is `finer` times as exact.
void check(const View &view, Sensor sensor, const Bounces &bounces, double finer) {
  const auto coarse = glm::max(sensor.resolution / 4u, glm::uvec2(8));
  sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / glm::dvec2(coarse);
  sensor.resolution = coarse;
  Simulator simulator(SimulatorOptions{});
  const auto frame = [&](double error_m) {
    simulator.prepare(view.scene, sensor, view.illuminators, Backscatter::lambert, Shadows::automatic, {},
                      {bounces.count, error_m});
    return simulator.measure();
  };
  const Measurement asked = frame(bounces.max_error_m), exact = frame(bounces.max_error_m / finer);
  std::vector<float> off, claimed;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < asked.returns[0].multipath_m.size(); ++i) {
    const float a = asked.returns[0].multipath_m[i], b = exact.returns[0].multipath_m[i];
    if (std::isnan(a) || std::isnan(b))
      continue;
    off.push_back(std::abs(a - b));
    claimed.push_back(asked.returns[0].multipath_error_m[i]);
    kept += off.back() <= claimed.back() ? 1u : 0u;
  }
  std::ranges::sort(off);
  std::ranges::sort(claimed);
  for (const double part : {0.5, 0.9, 0.95, 0.99}) {
    const auto at = static_cast<std::size_t>(part * static_cast<double>(off.size() - 1));
    fmt::print("  {:.0f} % off by at most {:.3f} mm, claimed {:.3f} mm\n", 100 * part,
               1e3 * static_cast<double>(off[at]), 1e3 * static_cast<double>(claimed[at]));
  }
  fmt::print("  claims kept: {:.2f} %\n",
             100.0 * static_cast<double>(kept) / static_cast<double>(off.size()));
}

// [check] blocks | sphereN | SETUP, then bounces, error_m and frequencies.
int main(int count, char **arguments) {
  const bool is_checked = count > 1 && std::string(arguments[1]) == "check";
  if (is_checked) {
    --count;
    ++arguments;
  }
  const std::string name = count > 1 ? arguments[1] : "blocks";
  const Bounces bounces{count > 2 && std::string(arguments[2]) != "all"
                            ? static_cast<std::uint32_t>(std::stoul(arguments[2]))
                            : all_bounces,
                        count > 3 ? std::stod(arguments[3]) : 1e-3};
  const View view = view_of(name);
  Simulator simulator(SimulatorOptions{});
  Sensor sensor = view.sensor;
  if (count > 4) {
    sensor.modulation_hz.clear();
    for (int i = 4; i < count; ++i)
      sensor.modulation_hz.push_back(std::stod(arguments[i]));
  }
  simulator.prepare(view.scene, sensor, view.illuminators, Backscatter::lambert, Shadows::automatic, {},
                    bounces);
  if (is_checked)
    check(view, sensor, bounces, 2.0);
  for (int round = 0; round < 2; ++round) {
    const Measurement frame = simulator.measure();
    std::string passes;
    for (const PassTime &pass : frame.passes)
      passes += fmt::format(" {} {:.0f}", pass.name, pass.ms);
    fmt::print("{:.0f} ms:{}\n", frame.frame_ms, passes);
    const Return &first = frame.returns[0];
    fmt::print(
        "elements {} lines {:.2f} M products {} claimed {:.3f} mm, multipath median {:.3f} mm, share {:.3f}, "
        "distance {:.5f} amplitude {:.6f} of direct {:.6f}\n",
        frame.bounces->elements, static_cast<double>(frame.bounces->lines) / 1e6, frame.bounces->products,
        1e3 * frame.bounces->claimed_m, 1e3 * median(first.multipath_m), median(first.indirect_share),
        median(first.distance_m), median(first.amplitude), median(first.direct_amplitude));
  }
}
