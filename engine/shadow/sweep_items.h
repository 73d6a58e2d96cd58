#pragma once
// The edges that may be silhouettes as seen from a board.

#include "engine/shadow/boards.h"
#include "engine/shadow/occluders.h"
#include "shaders/shadow/sweep_interface.h"

#include <array>
#include <vector>

namespace pmdsim {

// Four texels in the shader. Places and unit normals are in the board's frame.
struct SweepItem {
  glm::vec3 a;
  std::uint32_t first; // triangle along which the edge runs from a to b
  glm::vec3 b;
  std::uint32_t second; // the other one, or item_boundary
  glm::vec3 first_normal;
  std::uint32_t first_packed;  // rests of a, ten bits each; bits 30, 31: 1 if all of the board is in front of
                               // the triangle, 2 if behind
  glm::vec3 second_normal;     // turned over where it runs from a to b as well
  std::uint32_t second_packed; // likewise of b
};
static_assert(sizeof(SweepItem) == 64);

// A triangle as a board sees it.
struct BoardTriangle {
  std::array<glm::dvec3, 3> corners_m; // board frame
  glm::dvec3 normal;
  double offset_m;
  int side; // 1 where all of the board and the lens are in front, -1 where behind, 0 else
};

struct SweepItems {
  std::vector<SweepItem> edges;            // those that follow each other lie close together
  std::vector<shader::SweepPlanes> planes; // beside the edges
  // Likewise, triangles that the lens does not see and that may hide something from it all the same.
  std::vector<SweepItem> hidden;
  float rest_step = 0.0f; // of the packed rests, m
  // Triangles that come so near the way of the light's place from the lens to a diode that they may meet it.
  std::vector<BoardTriangle> in_the_way;
};

SweepItems sweep_items(const Board &board, const Occluders &occluders, const CameraScene &camera,
                       const Scene &scene);

// Those of the triangles that the straight way from the lens to a diode goes through, each with these diodes.
// `places_m` as places_of() gives them.
std::vector<shader::Piercer> find_piercers(const Board &board, const std::vector<BoardTriangle> &triangles,
                                           const std::vector<glm::dvec3> &places_m);

} // namespace pmdsim
