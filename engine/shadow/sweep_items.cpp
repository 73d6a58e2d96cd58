#include "engine/shadow/sweep_items.h"

#include "engine/shadow/place_order.h"
#include "engine/view/mesh_edges.h"
#include "engine/vulkan/float_pair.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

// A diode that is no farther from a triangle touches it, m: a file may put one there, but for rounding.
constexpr double touching_m = 1e-8;

// The sign of normal . p - offset all over the board's disc and the lens, else 0.
int side_of_board(const Board &board, const glm::dvec3 &normal, double offset_m) {
  const double reach_m = board.radius_m * std::hypot(normal.x, normal.y);
  const double at_lens_m = normal.z * board.lens_z_m - offset_m;
  const double at_low_m = normal.z * board.lowest_m - offset_m,
               at_high_m = normal.z * board.highest_m - offset_m;
  const double least_m = std::min({at_low_m - reach_m, at_high_m - reach_m, at_lens_m});
  const double most_m = std::max({at_low_m + reach_m, at_high_m + reach_m, at_lens_m});
  const double margin_m = 2e-6 + 1e-6 * std::abs(offset_m);
  return least_m > margin_m ? 1 : most_m < -margin_m ? -1 : 0;
}

glm::dvec3 corner_m(const glm::vec4 &hi, const glm::vec4 &lo) { return glm::dvec3(hi) + glm::dvec3(lo); }

BoardTriangle seen_from(const Board &board, const shader::Occluder &shape) {
  const glm::dvec3 normal = glm::normalize(board.rotation * corner_m(shape.plane_hi, shape.plane_lo));
  BoardTriangle triangle{{board.in_frame(corner_m(shape.a_hi, shape.a_lo)),
                          board.in_frame(corner_m(shape.b_hi, shape.b_lo)),
                          board.in_frame(corner_m(shape.c_hi, shape.c_lo))},
                         normal,
                         0.0,
                         0};
  triangle.offset_m = glm::dot(normal, triangle.corners_m[0]);
  triangle.side = side_of_board(board, normal, triangle.offset_m);
  return triangle;
}

// An edge between triangles, or of one alone.
struct Edge {
  glm::dvec3 a_m, b_m;
  std::uint32_t first, second; // in the triangles; no_id
  bool same_way;               // the second runs from a to b as well
};

// Whether all of the board is on the same side of both of the edge's triangles, so that the edge is no
// silhouette from anywhere on it.
bool is_never_silhouette(const Edge &edge, const std::vector<BoardTriangle> &triangles) {
  if (edge.second == no_id)
    return false;
  const int first = triangles[edge.first].side, second = triangles[edge.second].side;
  return first != 0 && first == (edge.same_way ? -second : second);
}

std::uint32_t packed_rest(const glm::dvec3 &place_m, double step) {
  std::uint32_t packed = 0;
  for (glm::length_t k = 0; k < 3; ++k) {
    const double rest = static_cast<double>(float_pair(place_m[k]).y);
    const long steps = std::clamp(std::lround(rest / step), -511l, 511l);
    packed |= (static_cast<std::uint32_t>(steps) & 1023u) << 10 * k;
  }
  return packed;
}

std::uint32_t packed_side(int side) { return side > 0 ? 1u << 30 : side < 0 ? 2u << 30 : 0u; }

struct ItemMaker {
  const std::vector<BoardTriangle> &triangles;
  const Occluders &occluders;
  double rest_step;

  void add_edge(const Edge &edge, SweepItems &to) const {
    const BoardTriangle &first = triangles[edge.first];
    const double turn = edge.same_way ? -1.0 : 1.0;
    const bool is_alone = edge.second == no_id;
    const glm::dvec3 second_normal = is_alone ? glm::dvec3(0.0) : turn * triangles[edge.second].normal;
    const double second_offset_m = is_alone ? 0.0 : turn * triangles[edge.second].offset_m;
    const int second_side = is_alone ? 0 : static_cast<int>(turn) * triangles[edge.second].side;
    to.edges.push_back({glm::vec3(edge.a_m), occluders.shapes[edge.first].id, glm::vec3(edge.b_m),
                        is_alone ? shader::item_boundary : occluders.shapes[edge.second].id,
                        glm::vec3(first.normal), packed_rest(edge.a_m, rest_step) | packed_side(first.side),
                        glm::vec3(second_normal),
                        packed_rest(edge.b_m, rest_step) | packed_side(second_side)});
    const DoublePair4 first_plane(first.normal, first.offset_m), second_plane(second_normal, second_offset_m);
    to.planes.push_back({first_plane.hi, first_plane.lo, second_plane.hi, second_plane.lo});
  }

  void add_hidden(std::uint32_t triangle, SweepItems &to) const {
    const auto &[a_m, b_m, c_m] = triangles[triangle].corners_m;
    to.hidden.push_back({glm::vec3(a_m), occluders.shapes[triangle].id, glm::vec3(b_m), shader::item_hidden,
                         glm::vec3(c_m), packed_rest(a_m, rest_step),
                         glm::vec3(std::bit_cast<float>(packed_rest(c_m, rest_step)), 0.0f, 0.0f),
                         packed_rest(b_m, rest_step)});
  }
};

// The edges that may be silhouettes. Where a neighbour is no occluder, or has holes, an edge is that of one
// triangle alone.
std::vector<Edge> edges_of(const std::vector<BoardTriangle> &triangles, const Occluders &occluders,
                           const Scene &scene) {
  std::vector<std::uint32_t> ids, index(scene.triangles.size(), no_id);
  ids.reserve(occluders.shapes.size());
  for (std::uint32_t i = 0; i < occluders.shapes.size(); ++i) {
    ids.push_back(occluders.shapes[i].id);
    index[ids.back()] = i;
  }
  const auto first_at = first_at_same_place(scene.positions_m);
  const std::vector<WeldedEdge> sides = welded_edges(scene, ids, first_at);
  const auto start_of = [&](const WeldedEdge &side) {
    return first_at[scene.triangles[side.triangle].vertices[side.side]];
  };
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const WeldedEdge &side = sides[i];
    if (side.low == side.high)
      continue;
    const auto &corners_m = triangles[index[side.triangle]].corners_m;
    Edge edge{corners_m[side.side], corners_m[(side.side + 1) % 3], index[side.triangle], no_id, false};
    if (i + 1 < sides.size() && sides[i + 1].low == side.low && sides[i + 1].high == side.high) {
      edge.second = index[sides[i + 1].triangle];
      edge.same_way = start_of(sides[i + 1]) == start_of(side);
      ++i;
    }
    if (!is_never_silhouette(edge, triangles))
      edges.push_back(edge);
  }
  return edges;
}

// The shapes that the lens does not see.
std::vector<std::uint32_t> hidden_shapes(const Occluders &occluders, const CameraScene &camera,
                                         const Scene &scene) {
  std::vector<bool> is_hidden(scene.shape_count());
  for (const CameraTriangle &triangle : camera.hidden)
    is_hidden[triangle.id] = true;
  std::vector<std::uint32_t> hidden;
  for (std::uint32_t i = 0; i < occluders.shapes.size(); ++i)
    if (is_hidden[occluders.shapes[i].id])
      hidden.push_back(i);
  return hidden;
}

// Whether a triangle meets the flat hull of board, origin and lens, or comes near it; by boxes and the eight
// supports.
bool stands_in_the_way(const Board &board, const BoardTriangle &triangle) {
  constexpr double margin_m = 2e-5, diagonal = 0.70710678118654752;
  const auto &[a, b, c] = triangle.corners_m;
  if (std::max({a.z, b.z, c.z}) < std::min(board.lowest_m, board.lens_z_m) - margin_m ||
      std::min({a.z, b.z, c.z}) > std::max(board.highest_m, board.lens_z_m) + margin_m)
    return false;
  const auto along = [&](const glm::dvec2 &u) {
    return std::min({glm::dot(glm::dvec2(a), u), glm::dot(glm::dvec2(b), u), glm::dot(glm::dvec2(c), u)});
  };
  constexpr std::array<glm::dvec2, 8> directions{glm::dvec2{1, 0},
                                                 {-1, 0},
                                                 {0, 1},
                                                 {0, -1},
                                                 {diagonal, diagonal},
                                                 {-diagonal, -diagonal},
                                                 {diagonal, -diagonal},
                                                 {-diagonal, diagonal}};
  for (std::size_t i = 0; i < directions.size(); ++i)
    if (along(directions[i]) > board.supports_m[i] + margin_m)
      return false;
  return true;
}

} // namespace

std::vector<shader::Piercer> find_piercers(const Board &board, const std::vector<BoardTriangle> &triangles,
                                           const std::vector<glm::dvec3> &places_m) {
  const glm::dvec3 lens_m(0.0, 0.0, board.lens_z_m);
  std::vector<shader::Piercer> piercers;
  for (const BoardTriangle &triangle : triangles) {
    const double lens_height_m = glm::dot(triangle.normal, lens_m) - triangle.offset_m;
    const double turn = lens_height_m < 0.0 ? -1.0 : 1.0;
    const DoublePair4 plane(turn * triangle.normal, turn * triangle.offset_m);
    shader::Piercer piercer{plane.hi, plane.lo, {}};
    bool any = false;
    const auto &[a, b, c] = triangle.corners_m;
    for (std::size_t d = 0; d < places_m.size(); ++d) {
      const glm::dvec3 place_m = board.in_frame(places_m[d]), way = place_m - lens_m;
      // A triangle that touches the diode is not in its way.
      if (turn * (glm::dot(triangle.normal, place_m) - triangle.offset_m) >= -touching_m)
        continue;
      const auto side = [&](const glm::dvec3 &from, const glm::dvec3 &to) {
        return glm::dot(glm::cross(from - lens_m, to - lens_m), way) > 0.0;
      };
      if (side(a, b) != side(b, c) || side(b, c) != side(c, a))
        continue;
      piercer.diodes[d / 32] |= 1u << d % 32;
      any = true;
    }
    if (any)
      piercers.push_back(piercer);
  }
  return piercers;
}

SweepItems sweep_items(const Board &board, const Occluders &occluders, const CameraScene &camera,
                       const Scene &scene) {
  SweepItems made;
  std::vector<BoardTriangle> triangles;
  triangles.reserve(occluders.shapes.size());
  double largest_m = 0.0;
  for (const shader::Occluder &shape : occluders.shapes) {
    triangles.push_back(seen_from(board, shape));
    if (stands_in_the_way(board, triangles.back()))
      made.in_the_way.push_back(triangles.back());
    for (const glm::dvec3 &corner : triangles.back().corners_m)
      largest_m = std::max({largest_m, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
  }
  // Half a unit in the last place of the largest coordinate takes 256 steps.
  const double step = std::exp2(std::ceil(std::log2(std::max(largest_m, 1e-9))) - 33.0);
  made.rest_step = static_cast<float>(step);
  const ItemMaker maker{triangles, occluders, step};

  const std::vector<Edge> edges = edges_of(triangles, occluders, scene);
  std::vector<glm::dvec3> middles_m;
  middles_m.reserve(edges.size());
  for (const Edge &edge : edges)
    middles_m.push_back(0.5 * (edge.a_m + edge.b_m));
  made.edges.reserve(edges.size());
  made.planes.reserve(edges.size());
  for (const std::uint32_t i : order_by_place(middles_m))
    maker.add_edge(edges[i], made);

  std::vector<std::uint32_t> hidden;
  middles_m.clear();
  for (const std::uint32_t i : hidden_shapes(occluders, camera, scene)) {
    hidden.push_back(i);
    middles_m.push_back((triangles[i].corners_m[0] + triangles[i].corners_m[1] + triangles[i].corners_m[2]) /
                        3.0);
  }
  for (const std::uint32_t i : order_by_place(middles_m))
    maker.add_hidden(hidden[i], made);
  return made;
}

} // namespace pmdsim
