#pragma once
// The scene: a triangle mesh in the world frame (glTF's: right-handed, +Y up), plain data in SI units.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// Marks "no triangle" and "no object" wherever an id is stored.
inline constexpr std::uint32_t no_id = 0xffffffffu;

struct Surface {
  double reflectivity = 1.0; // rho, 0 to 1
  bool double_sided = false; // false: the back face (clockwise seen) is invisible to the lens
};

struct Triangle {
  std::array<std::uint32_t, 3> vertices; // indices into Scene::positions_m; counter-clockwise is the front
  std::uint32_t surface;                 // index into Scene::surfaces
  std::uint32_t object;                  // index into Scene::objects
};

struct Scene {
  std::vector<glm::dvec3> positions_m; // world frame
  std::vector<Triangle> triangles;     // a triangle's id is its index here
  std::vector<Surface> surfaces;
  std::vector<std::string> objects; // names of the glTF nodes that carry meshes
};

// Backscatter B of a point lit from direction w, n the normal turned to the lens (1/sr):
// lambert: (rho/pi) * max(0, n.w); constant (the paper's B_n): rho where n.w > 0, else 0.
enum class Backscatter { lambert, constant };

} // namespace pmdsim
