#version 460
// Adds the depths to records of samples that are an even grid: where their rays meet their triangles' planes.
#extension GL_GOOGLE_include_directive : require
#include "shaders/sampling/grid.glsl"
#include "shaders/shared/constants.h"
#include "shaders/view/meet.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { RecordDepthsConstants constants; };
layout(constant_id = constant_general_chip) const uint general_chip = 0;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= constants.fragments)
    return;
  uvec2 ids = load_words(constants.ids, 2 * i);
  bool hit = ids.x != 0u;
  Real3 ray = ray_of(row_by_row(i, constants.grid.columns, constants.grid.inverse_columns), constants.grid, constants.chip,
                     general_chip != 0);
  Real depth = depth_on_plane(ray, load_plane(constants.planes, hit ? ids.y : 0u));
  store_words(constants.ids, 2 * i + 1, words_of(hit ? depth : real(0.0)));
}
