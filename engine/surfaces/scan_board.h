#pragma once
// The data that the loops of scan_kernel.cpp share with HemisphereScan: plain, as these loops are compiled
// for several instruction sets.

#include <cstddef>
#include <cstdint>

namespace pmdsim {

inline constexpr std::size_t most_bins = 768; // a multiple of 16, as is each count

// Equal parts of a line's half turn.
struct LineBins {
  std::uint32_t count;
  const float *x, *y;     // directions in their middles, from the axis; with room for 16 more
  const float *cotangent; // of the middle's angle
};

// What one line over a hemisphere sees, a direction in the middle of each of its bins, from the axis to the
// axis's other end. Where it sees nothing its share is 0, and its face one that sends no light.
struct SeenLine {
  const LineBins *bins;
  alignas(64) std::int32_t face[most_bins]; // face_of
  // Of the point that is seen: weights of the second and the third corner of the scene's triangle.
  alignas(64) float u[most_bins], v[most_bins];
  alignas(64) float length_m[most_bins]; // of the way there
  // Of what arrives at the place, for each unit that leaves the face; in a closed scene those of all lines
  // sum to 1.
  alignas(64) float share[most_bins];
  float cosine, sine; // of the angle between the surface and the half plane
};

// at + u * weight of the second corner + v * that of the third, of a place in a triangle. Places where it is
// not negative lie in the node `next`, others in the one that follows it; ~facet is a node without halves.
struct FacetCut {
  float at, u, v;
  std::int32_t next;
};

// The triangles of a scene, by number, and the facets that they are cut into.
struct ScanScene {
  const float *x_m, *y_m, *z_m; // vertices
  std::uint32_t vertices;
  const std::int32_t *corners[3];
  std::uint32_t triangles;
  // A triangle's places are in cells, so many along u and v: a cell holds a node of cuts, or ~facet.
  const std::int32_t *first_cell, *cells_along;
  const std::int32_t *cells;
  const FacetCut *cuts;
  LineBins bins;
  std::int32_t dark_face;
  float lowest_m; // over a surface: what is nearer to its plane is not seen
  // Triangles with cutouts; all null where there are none.
  const std::uint8_t *is_masked;
  bool (*is_there)(const void *of, std::int32_t triangle, float u, float v);
  const void *is_there_of;
};

// A place's frame: x and y in the surface, z along its normal, each by its coordinates of the scene.
struct ScanFrame {
  float from_m[3], x[3], y[3], z[3];
  std::uint32_t lines;
};

// What a place sees: vertices in its frame, and the lines between which they lie. Bit 0 of `code` says that a
// vertex is below the surface, the others hold the number of the first line beyond it, or beyond its mirror
// image above. Vertices alone decide on which side of a line they are, so that triangles beside each other
// agree on the edge that they share.
struct ScanVertices {
  float *x_m, *y_m, *z_m;
  std::int32_t *code;
};

// Triangles that lines meet, with the first line that does and one past the last. The first is -1 where these
// do not tell, as a part of the triangle lies below. There is room for 16 more than the scene has.
struct MetTriangles {
  std::int32_t *triangle, *first_line, *end_line;
};

// The parts of a line's plane that triangles are, ends in the order of their angles. Coordinates in the half
// plane are x along the axis and y above the surface. 1 / length, and each weight over the length, are linear
// in the direction.
struct Stretches {
  float *nearness_x, *nearness_y, *u_x, *u_y, *v_x, *v_y;
  float *low_rad, *high_rad;
  std::int32_t *first_bin, *end_bin;
  std::int32_t *triangle, *side;
};
inline constexpr std::size_t stretch_floats = 8, stretch_integers = 4;

struct LineTask {
  const std::int32_t *triangles; // that meet the line; room for 16 more behind them
  std::uint32_t count;
  std::int32_t line;
  float cosine, sine; // of the angle between the surface and the half plane
  float share;        // of a radian of the line in the middle of it
};

struct ScanLoops {
  void (*see_vertices)(const ScanScene &scene, const ScanFrame &frame, const ScanVertices &to);
  // Lists the triangles that some line may meet; returns their number.
  std::uint32_t (*find_triangles)(const ScanScene &scene, const ScanVertices &vertices,
                                  const MetTriangles &to);
  // `stretches` has room for 16 more than the task's triangles.
  void (*see_line)(const ScanScene &scene, const ScanVertices &vertices, const LineTask &task,
                   const Stretches &stretches, SeenLine &seen);
};

} // namespace pmdsim
