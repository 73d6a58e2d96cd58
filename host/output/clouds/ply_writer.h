#pragma once
// PLY, which viewers and libraries of point clouds read: MeshLab, CloudCompare, Blender, Open3D, PCL.

#include "host/output/clouds/cloud.h"
#include "host/output/files/h5_writer.h"
#include "host/output/files/output_file.h"

#include <glm/glm.hpp>
#include <span>

namespace pmdsim {

// "binary_little_endian 1.0", one element `vertex` with a point for each pixel that has a distance, row by
// row. float x, y, z (world frame, metres); float nx, ny, nz where there are `normals`, one a pixel, world
// frame, turned to the lens; uchar red, green, blue (PointCloud::colour()); then, as far as the frame has
// them, of the frequency of the distances or else of the first: float amplitude, the distance by its
// channel's name, range_m, deformation_mm; uint object_id; and uint row, column. Comments tell of program,
// sensor, frame, the frame of reference and world_from_camera. May be called from several threads at once.
// Throws Error (output). Source: G. Turk, "The PLY Polygon File Format".
void write_ply(OutputFile &file, const PointCloud &cloud, std::span<const glm::vec3> normals,
               const FrameLabel &label);

} // namespace pmdsim
