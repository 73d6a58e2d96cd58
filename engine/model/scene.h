#pragma once
// The scene: triangles and points in the world frame (glTF's: right-handed, +Y up), plain data in SI units.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// Which diodes light which point: V_nm of the paper's eq. 5 to 7. A diode reaches a sample where it stands in
// front of the surface that the lens sees there and no shape of the scene, whichever side it shows, lies
// between them. The sample's own shape never stands in its way. `off`: whatever lies between.
enum class Shadows { off, automatic };

// Marks "no triangle or disc" and "no object" wherever an id is stored.
inline constexpr std::uint32_t no_id = 0xffffffffu;

// Linear RGBA, 0 to 1, row-major; row 0 holds what glTF puts at v = 0, the image's top.
struct Texture {
  glm::uvec2 size{0, 0}; // columns, rows
  std::vector<glm::vec4> texels;
};

// How texture coordinates outside 0 to 1 fold back into it.
enum class Wrap { repeat, mirrored_repeat, clamp };
// The nearest texel, or linear between the four around. A sample is an exact ray and covers no area of a
// texture, so there are no mip levels: what a pixel averages are its samples.
enum class TextureFilter { nearest, linear };

// The colour of a surface where it varies: texel times vertex colour, white and opaque where there is none.
struct Paint {
  glm::dvec3 reflectivity_rgb{0.0}; // of the colour's linear red, green, blue: rho += dot(this, colour)
  std::shared_ptr<const Texture> texture = nullptr; // or none
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  TextureFilter filter = TextureFilter::linear;
  double alpha = 1.0;        // of the surface, times the colour's
  double alpha_cutoff = 0.0; // the surface is not there where its alpha is below; 0: it is everywhere

  bool operator==(const Paint &) const = default; // with the same texture, not one that is equal
};

struct Surface {
  double reflectivity = 1.0;                 // rho, 0 to 1; of a painted surface what its paint adds to
  bool double_sided = false;                 // false: the back face (clockwise seen) is invisible to the lens
  std::optional<Paint> paint = std::nullopt; // nothing where the surface is the same everywhere

  bool operator==(const Surface &) const = default;
};

struct Triangle {
  std::array<std::uint32_t, 3> vertices; // indices into Scene::positions_m; counter-clockwise is the front
  std::uint32_t surface;                 // index into Scene::surfaces
  std::uint32_t object;                  // index into Scene::objects

  bool operator==(const Triangle &) const = default;
};

// A point of a point cloud: a disc about its vertex that faces whichever lens looks at it, so that it counts
// by the area that it covers. Its colour is its vertex's.
struct Disc {
  std::uint32_t vertex; // index into Scene::positions_m
  double radius_m;      // > 0
  std::uint32_t surface;
  std::uint32_t object;

  bool operator==(const Disc &) const = default;
};

struct Scene {
  std::vector<glm::dvec3> positions_m; // world frame
  std::vector<Triangle> triangles;     // a triangle's id is its index here
  std::vector<Surface> surfaces;
  std::vector<std::string> objects; // names of the glTF nodes that carry meshes
  std::vector<Disc> discs;          // a disc's id is triangles.size() + its index here
  // Beside positions_m, or empty where no surface needs them.
  std::vector<glm::dvec2> texture_coordinates; // (u, v), u to the right, v down, 1 a whole texture
  std::vector<glm::vec4> colours;              // linear RGBA

  bool operator==(const Scene &) const = default;

  // Triangles and discs.
  std::size_t shape_count() const { return triangles.size() + discs.size(); }
  std::uint32_t surface_of(std::uint32_t id) const {
    return id < triangles.size() ? triangles[id].surface : discs[id - triangles.size()].surface;
  }
  std::uint32_t object_of(std::uint32_t id) const {
    return id < triangles.size() ? triangles[id].object : discs[id - triangles.size()].object;
  }
  bool is_disc(std::uint32_t id) const { return id >= triangles.size(); }
  // Whether a shape's surface may not be there everywhere.
  bool is_masked(std::uint32_t id) const {
    const std::optional<Paint> &paint = surfaces[surface_of(id)].paint;
    return paint && paint->alpha_cutoff > 0.0;
  }
};

// Backscatter B of a point lit from direction w, n the normal turned to the lens (1/sr):
// lambert: (rho/pi) * max(0, n.w); constant (the paper's B_n): rho where n.w > 0, else 0.
enum class Backscatter { lambert, constant };

} // namespace pmdsim
