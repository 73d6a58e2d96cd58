// Files that people's tools wrote: the frame that Blender's own numbers ask for, and the same frame from
// files that gltfpack packed. scenes/blender/expected.py and scenes/make_packed.py say where the numbers come
// from.

#include "engine/reference/view/lens_model.h"
#include "host/input/setup/setup.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <unistd.h>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

const std::filesystem::path scenes = PMDSIM_SCENES;

json read_json(const std::string &name) {
  std::ifstream stream(std::filesystem::path(PMDSIM_EXPECTED) / name);
  return json::parse(stream);
}

glm::dvec3 vector_of(const json &numbers) { return {numbers.at(0), numbers.at(1), numbers.at(2)}; }

// The setup `name` over another scene file.
Setup with_scene(const std::string &name, const std::string &scene) {
  std::ifstream stream(scenes / name);
  json setup = json::parse(stream, nullptr, true, true);
  setup["scene"] = (scenes / scene).string();
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("pmdsim-{}-{}.json", ::getpid(), name.size());
  std::ofstream(file) << setup;
  Setup loaded = load_setup(file);
  std::filesystem::remove(file);
  return loaded;
}

std::vector<glm::dvec3> vertices_of(const Scene &scene, const std::string &object) {
  std::vector<glm::dvec3> vertices;
  for (const Triangle &triangle : scene.triangles)
    if (scene.objects[triangle.object] == object)
      for (const std::uint32_t vertex : triangle.vertices)
        vertices.push_back(scene.positions_m[vertex]);
  for (const Disc &disc : scene.discs)
    if (scene.objects[disc.object] == object)
      vertices.push_back(scene.positions_m[disc.vertex]);
  return vertices;
}

// The largest distance from one of `from` to the nearest of `to`.
double farthest_m(const std::vector<glm::dvec3> &from, const std::vector<glm::dvec3> &to) {
  double farthest = 0.0;
  for (const glm::dvec3 &a : from) {
    double nearest = 1e9;
    for (const glm::dvec3 &b : to)
      nearest = std::min(nearest, glm::distance(a, b));
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

double largest_displacement_m(const Scene &scene, const json &objects) {
  double largest = 0.0;
  for (const auto &[name, object] : objects.items()) {
    std::vector<glm::dvec3> expected;
    for (const json &vertex : object.at("vertices_m"))
      expected.push_back(vector_of(vertex));
    const std::vector<glm::dvec3> found = vertices_of(scene, name);
    INFO(name);
    REQUIRE(!found.empty());
    largest = std::max({largest, farthest_m(expected, found), farthest_m(found, expected)});
  }
  return largest;
}

// One pixel that looks at a point of a surface along its normal, so close that nothing is between.
Sensor looking_at(const glm::dvec3 &point_m, const glm::dvec3 &normal) {
  constexpr double distance_m = 0.01;
  Sensor sensor;
  sensor.resolution = {1, 1};
  sensor.pixel_pitch_m = glm::dvec2(1e-9);
  const glm::dvec3 aside = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(aside, normal));
  sensor.world_from_camera = {glm::dmat3(x, glm::cross(-normal, x), -normal), point_m + distance_m * normal};
  return sensor;
}

glm::dvec3 normal_of(const Scene &scene, const std::string &object) {
  const auto triangle = std::ranges::find_if(
      scene.triangles, [&](const Triangle &candidate) { return scene.objects[candidate.object] == object; });
  const auto &[a, b, c] = triangle->vertices;
  return glm::normalize(
      glm::cross(scene.positions_m[b] - scene.positions_m[a], scene.positions_m[c] - scene.positions_m[a]));
}

// The rho measured by a pixel that looks straight at a point, or 0 where the object is not there.
double reflectivity_at(Simulator &simulator, const Scene &scene, const std::string &object,
                       const json &point) {
  const Sensor sensor = looking_at(vector_of(point.at("point_m")), normal_of(scene, object));
  simulator.prepare(scene, sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  const Measurement measured = simulator.measure();
  const std::uint32_t id = measured.object_id[0];
  if (id == no_id || scene.objects[id] != object)
    return 0.0;
  const double range_m = measured.range_m[0];
  return static_cast<double>(measured.returns[0].amplitude[0]) * range_m * range_m;
}

// The rho of the object's vertex at `point_m`, by its paint and its own colour; NaN where there is none.
double reflectivity_of_vertex(const Scene &scene, const std::string &object, const glm::dvec3 &point_m) {
  const auto rho = [&](std::uint32_t shape, std::uint32_t vertex) {
    const bool found = scene.objects[scene.object_of(shape)] == object &&
                       glm::distance(scene.positions_m[vertex], point_m) <= 1e-5;
    const Surface &surface = scene.surfaces[scene.surface_of(shape)];
    return found ? surface.reflectivity +
                       glm::dot(surface.paint->reflectivity_rgb, glm::dvec3(scene.colours[vertex]))
                 : std::nan("");
  };
  double result = std::nan("");
  for (std::uint32_t id = 0; id < scene.triangles.size(); ++id)
    for (const std::uint32_t vertex : scene.triangles[id].vertices)
      result = std::fmax(result, rho(id, vertex));
  for (std::uint32_t i = 0; i < scene.discs.size(); ++i)
    result =
        std::fmax(result, rho(static_cast<std::uint32_t>(scene.triangles.size()) + i, scene.discs[i].vertex));
  return result;
}

} // namespace

TEST_CASE("A file of Blender's is in every frame where Blender says") {
  const json expected = read_json("blender.json");
  const auto tolerance_m = expected.at("tolerance_m").get<double>();
  Simulator simulator = make_simulator();
  fmt::print("{:<20}{:>8}{:>22}{:>16}\n", "Blender's scene", "t, s", "vertices off by, um", "plate, um");
  for (const char *name : {"blender/moving.glb", "blender/moving_keys.glb"}) {
    const Setup setup = with_scene("blender/moving.json", name);
    for (const json &time : expected.at("times")) {
      const auto time_s = time.at("time_s").get<double>();
      const Instant instant = setup.at(time_s);
      INFO(name << " at " << time_s << " s");
      const double displacement_m = largest_displacement_m(instant.scene, time.at("objects"));
      CHECK(displacement_m <= tolerance_m);
      const Pose &camera = instant.sensors[0].world_from_camera;
      const json &node = time.at("nodes").at("Camera");
      CHECK(glm::distance(camera.translation_m, vector_of(node.at("position_m"))) <= tolerance_m);
      CHECK(glm::distance(camera.direction({0, 0, 1}), vector_of(node.at("view_axis"))) <= 1e-5);
      CHECK(glm::distance(camera.direction({0, -1, 0}), vector_of(node.at("up"))) <= 1e-5);
      const json &light = time.at("nodes").at("Light");
      const Pose &headlight = instant.illuminators[1].world_from_illuminator;
      CHECK(glm::distance(headlight.translation_m, vector_of(light.at("position_m"))) <= tolerance_m);
      CHECK(glm::distance(headlight.direction({0, 0, 1}), vector_of(light.at("view_axis"))) <= 1e-5);

      Sensor axis = instant.sensors[0]; // a pixel on the optical axis, under light in the lens
      axis.resolution = {1, 1};
      axis.samples = 1;
      axis.pixel_pitch_m = glm::dvec2(1e-9);
      simulator.prepare(instant.scene, axis, {monostatic_illuminator(camera)}, Backscatter::lambert);
      const double error_m = static_cast<double>(simulator.measure().returns[0].distance_m[0]) -
                             time.at("plate_range_m").get<double>();
      CHECK(std::abs(error_m) <= tolerance_m);
      fmt::print("{:<20}{:>8.2f}{:>22.3f}{:>16.3f}\n", std::string(name).substr(8), time_s,
                 1e6 * displacement_m, 1e6 * error_m);
    }
  }
}

TEST_CASE("A file of Blender's reflects as Blender's images and colours say") {
  const json expected = read_json("blender.json");
  const Setup setup = with_scene("blender/moving.json", "blender/moving.glb");
  const Scene &scene = setup.start.scene;
  Simulator simulator = make_simulator();
  for (const json &point : expected.at("textures")) {
    const auto object = point.at("object").get<std::string>();
    INFO(object << " at " << point.at("texture_coordinate").dump());
    const double rho = point.at("is_there").get<bool>() ? point.at("reflectivity").get<double>() : 0.0;
    const double tolerance = expected.at(object == "Print" ? "tolerance_jpeg" : "tolerance_colour");
    CHECK(std::abs(reflectivity_at(simulator, scene, object, point) - rho) <= tolerance);
  }
  for (const auto &[object, reflectivity] : expected.at("reflectivity").items()) {
    const auto of_object = std::ranges::find_if(
        scene.triangles, [&](const Triangle &triangle) { return scene.objects[triangle.object] == object; });
    INFO(object);
    CHECK(scene.surfaces[of_object->surface].reflectivity ==
          Approx(reflectivity.get<double>()).epsilon(1e-4));
  }
  for (const auto &[object, points] : expected.at("vertex_colours").items())
    for (const json &point : points) {
      INFO(object << " at " << point.at("point_m").dump());
      CHECK(reflectivity_of_vertex(scene, object, vector_of(point.at("point_m"))) ==
            Approx(point.at("reflectivity").get<double>()).margin(1e-4));
    }
  for (const json &point : expected.at("vertex_colours").at("Cloud"))
    CHECK(std::ranges::any_of(scene.discs, [&](const Disc &disc) {
      return glm::distance(scene.positions_m[disc.vertex], vector_of(point.at("point_m"))) <= 1e-5 &&
             std::abs(disc.radius_m - point.at("radius_m").get<double>()) <= 1e-7;
    }));
}

namespace {

Measurement frame_of(Simulator &simulator, const Instant &instant, Backscatter backscatter) {
  simulator.prepare(instant.scene, instant.sensors[0], instant.illuminators, backscatter);
  return simulator.measure();
}

std::string object_seen(const Measurement &measured, const Scene &scene, std::size_t pixel) {
  return measured.object_id[pixel] == no_id ? "" : scene.objects[measured.object_id[pixel]];
}

// Whether a pixel and the eight around it see the same object in both frames, all of it.
bool inside_object(const Measurement &a, const Scene &scene_a, const Measurement &b, const Scene &scene_b,
                   std::uint32_t column, std::uint32_t row) {
  std::set<std::string> seen;
  for (std::uint32_t y = row - 1; y <= row + 1; ++y)
    for (std::uint32_t x = column - 1; x <= column + 1; ++x) {
      const std::size_t pixel = std::size_t{y} * a.resolution.x + x;
      seen.insert(a.coverage[pixel] < 1.0f ? "" : object_seen(a, scene_a, pixel));
      seen.insert(b.coverage[pixel] < 1.0f ? "" : object_seen(b, scene_b, pixel));
    }
  return seen.size() == 1 && !seen.begin()->empty();
}

// Only objects that stand still are compared: the keys of the others are quantized, too.
bool is_animated(const std::string &object) {
  static const std::set<std::string> animated{"Plate", "Cart", "Spinner", "Sleeve"};
  return animated.contains(object);
}

struct Difference {
  std::size_t pixels = 0;
  double distance_max_m = 0.0;
  // Over pixels that see the same facet, from its point to the packed facet's plane: distance times the
  // cosine of incidence.
  double surface_max_m = 0.0;
  double amplitude_mean = 0.0;
};

// Cosine between a pixel's ray and the normal of what it sees.
double incidence(const Measurement &measured, const Instant &instant, std::size_t pixel) {
  const Sensor &sensor = instant.sensors[0];
  const glm::uvec2 at(pixel % sensor.resolution.x, pixel / sensor.resolution.x);
  const glm::dvec3 ray = sensor.world_from_camera.direction(*reference::LensModel(sensor).sample_ray(at));
  const auto &[a, b, c] = instant.scene.triangles[measured.triangle_id[pixel]].vertices;
  const auto &positions_m = instant.scene.positions_m;
  return std::abs(glm::dot(
      glm::normalize(glm::cross(positions_m[b] - positions_m[a], positions_m[c] - positions_m[a])), ray));
}

// Whether each corner of one is near one of the other's.
bool same_facet(const Scene &a, std::uint32_t of_a, const Scene &b, std::uint32_t of_b) {
  constexpr double near_m = 1e-3;
  return std::ranges::all_of(a.triangles[of_a].vertices, [&](std::uint32_t corner) {
    return std::ranges::any_of(b.triangles[of_b].vertices, [&](std::uint32_t other) {
      return glm::distance(a.positions_m[corner], b.positions_m[other]) < near_m;
    });
  });
}

Difference difference_of(const Measurement &plain, const Instant &of_plain, const Measurement &packed,
                         const Instant &of_packed) {
  const Return &a = plain.returns[0], &b = packed.returns[0];
  Difference difference;
  for (std::uint32_t row = 1; row + 1 < plain.resolution.y; ++row)
    for (std::uint32_t column = 1; column + 1 < plain.resolution.x; ++column) {
      const std::size_t pixel = std::size_t{row} * plain.resolution.x + column;
      if (!inside_object(plain, of_plain.scene, packed, of_packed.scene, column, row) ||
          is_animated(object_seen(plain, of_plain.scene, pixel)) || !(a.amplitude[pixel] > 0.0f))
        continue;
      const double error_m = std::abs(static_cast<double>(b.distance_m[pixel] - a.distance_m[pixel]));
      ++difference.pixels;
      difference.distance_max_m = std::max(difference.distance_max_m, error_m);
      if (same_facet(of_plain.scene, plain.triangle_id[pixel], of_packed.scene, packed.triangle_id[pixel]))
        difference.surface_max_m =
            std::max(difference.surface_max_m, error_m * incidence(packed, of_packed, pixel));
      difference.amplitude_mean +=
          std::abs(static_cast<double>(b.amplitude[pixel] / a.amplitude[pixel]) - 1.0);
    }
  difference.amplitude_mean /= static_cast<double>(difference.pixels);
  return difference;
}

} // namespace

TEST_CASE("Files that gltfpack packed give the plain file's frame to the precision of their quantization") {
  Simulator simulator = make_simulator();
  fmt::print("{:<32}{:>10}{:>12}{:>14}{:>14}{:>16}\n", "packed file", "pixels", "step, um", "distance, um",
             "surface, um", "mean amplitude");
  const json packed_files = read_json("packed.json");
  for (const json &file : packed_files.at("files")) {
    const auto name = file.at("file").get<std::string>(), plain_name = file.at("plain").get<std::string>();
    const std::string base = plain_name == "room.glb"          ? "room.json"
                             : plain_name == "packed/grid.glb" ? "packed/grid.json"
                                                               : "blender/moving.json";
    const Setup plain = with_scene(base, plain_name), packed = with_scene(base, name);
    Instant of_plain = plain.at(0.5), of_packed = packed.at(0.5);
    of_plain.scene.discs.clear(); // packing drops their radii
    of_packed.scene.discs.clear();
    for (Instant *instant : {&of_plain, &of_packed})
      for (Illuminator &light : instant->illuminators)
        light.diodes.resize(std::min<std::size_t>(light.diodes.size(), 24));
    for (Instant *instant : {&of_plain, &of_packed}) {
      Sensor &sensor = instant->sensors[0];
      sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / glm::dvec2(160, 120);
      sensor.resolution = {160, 120};
      sensor.samples = 1;
    }
    const Measurement a = frame_of(simulator, of_plain, plain.backscatter);
    const Measurement b = frame_of(simulator, of_packed, packed.backscatter);
    const Difference difference = difference_of(a, of_plain, b, of_packed);
    const auto step_m = file.at("position_step_m").get<double>();
    fmt::print("{:<32}{:>10}{:>12.1f}{:>14.2f}{:>14.2f}{:>16.2e}\n", name.substr(7), difference.pixels,
               1e6 * step_m, 1e6 * difference.distance_max_m, 1e6 * difference.surface_max_m,
               difference.amplitude_mean);
    INFO(name);
    CHECK(difference.pixels > 2000);
    CHECK(difference.surface_max_m <= 0.5 * std::sqrt(3.0) * step_m + 2e-6); // a corner's largest shift
    CHECK(difference.amplitude_mean <= 2e-3); // colours of 8 bits, texture coordinates of 12
  }
}
