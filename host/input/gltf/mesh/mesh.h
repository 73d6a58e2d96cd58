#pragma once
// A glTF primitive as triangles or points in the world frame.

#include "engine/model/scene.h"
#include "host/input/file/input_error.h"
#include "host/input/gltf/material/material.h"
#include "host/input/gltf/mesh/attributes.h"
#include "host/input/gltf/skin.h"

namespace pmdsim {

inline constexpr std::size_t max_scene_vertices = std::size_t{1} << 25; // and as many triangles and points

// Where a primitive is in the world and what it is made of.
struct PrimitiveUse {
  const Placement &placement;
  const GltfMaterial &material;
  std::uint32_t surface, object; // indices into Scene::surfaces, which has the material's, and Scene::objects
};

// Appends the primitive's vertices, with their colours (COLOR_0) and the coordinates that the material's
// texture asks for, and its triangles (TRIANGLES, TRIANGLE_STRIP or TRIANGLE_FAN, indexed or not) or points
// (POINTS) to `scene`. Where the placement mirrors a triangle, judged at its first corner, the winding is
// turned, so that the front stays the front. Triangles without an area, such as strips are stitched with,
// stay too: ids count what the file holds. `shapes` counts indices so far, also those of points too small to
// be there. Throws Error (input) at the primitive's place.
void append_primitive(const GltfPrimitive &primitive, const PrimitiveUse &use, std::size_t &shapes,
                      Scene &scene);

} // namespace pmdsim
