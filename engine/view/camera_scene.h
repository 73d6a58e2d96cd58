#pragma once
// The scene as the lens sees it: camera frame (x right, y down, z forward, origin at the
// lens), made in double before anything becomes float.

#include "engine/model/scene.h"
#include "engine/model/sensor.h"
#include "shaders/shared/interface.h"

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace pmdsim {

// A triangle, or the one around a disc.
struct CameraTriangle {
  std::array<glm::dvec3, 3> corners_m; // camera frame
  std::uint32_t id;                    // of the triangle or the disc in the scene
};

// The plane normal . P = offset_m, camera frame, the normal of unit length; for shapes that the lens sees it
// is turned to the lens, so that offset_m < 0.
struct Plane {
  glm::dvec3 normal;
  double offset_m;
};

// The plane of a triangle whose corners run counter-clockwise seen from the side that the normal points to;
// empty where it has no area.
std::optional<Plane> front_plane(const std::array<glm::dvec3, 3> &corners_m);

struct CameraScene {
  // The shapes that the lens can see: without those of no area, those seen edge-on and culled back faces.
  std::vector<CameraTriangle> triangles;
  std::vector<Plane> planes; // beside `triangles`
  // The shapes that it cannot see and that stand in the light all the same; not those of no area.
  std::vector<CameraTriangle> hidden;
  double world_rounding_m = 0.0; // the error that places in the world, in double, may have
};

// Holds the visible parts of some consecutive triangles, before one hides another, or lights; empty at first.
struct VisibleBox {
  glm::dvec3 low_m{std::numeric_limits<double>::infinity()}; // camera frame
  glm::dvec3 high_m{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3 &p_m) {
    low_m = glm::min(low_m, p_m);
    high_m = glm::max(high_m, p_m);
  }
  int longest_side() const {
    const glm::dvec3 size_m = high_m - low_m;
    return size_m.x >= size_m.y ? (size_m.x >= size_m.z ? 0 : 2) : (size_m.y >= size_m.z ? 1 : 2);
  }
};

CameraScene to_camera(const Scene &scene, const Sensor &sensor);

// The measure that TrianglePlane::along_* bound: the ray's depth, or its range.
enum class AlongRay { depth, range };

// B of a fully lit surface over its reflectivity: 1 / pi for Lambert's.
double backscatter_per_reflectivity(Backscatter backscatter);

// The records that the points passes look up by id, one for each of the scene's shapes.
std::vector<shader::TrianglePlane> triangle_planes(const CameraScene &camera, const Scene &scene,
                                                   Backscatter backscatter, AlongRay along);

} // namespace pmdsim
