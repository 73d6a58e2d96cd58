#pragma once
// A glTF primitive of points as discs.

#include "engine/model/scene.h"
#include "host/input/file/input_error.h"
#include "host/input/gltf/placement.h"

namespace tinygltf {
class Model;
struct Primitive;
} // namespace tinygltf

namespace pmdsim {

// The world radius of each of a POINTS primitive's vertices: the attribute _RADIUS, in the mesh's units, else
// that of the area extras.pmdsim_point_area_m2 of its material. The node scales both with the cube root of
// its change of volume; but an area's radius stays where positions are quantized, for their node's scale is
// part of the quantization and their unit no metre. Throws Error (input) at `place`, /meshes/I/primitives/K.
std::vector<double> point_radii_m(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                                  const Placement &placement, std::size_t vertex_count, const Place &place);

// A disc for each index, but for points smaller than min_length_m: what a node scales to nothing is not
// there.
void append_discs(const std::vector<std::uint32_t> &indices, const std::vector<double> &radii_m,
                  std::uint32_t first_vertex, std::uint32_t surface, std::uint32_t object, Scene &scene);

} // namespace pmdsim
