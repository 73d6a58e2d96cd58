#include "engine/shadow/occluders.h"

#include "engine/shadow/point_set.h"
#include "engine/view/camera_scene.h"
#include "engine/view/mesh_edges.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace pmdsim {
namespace {

// What meshes hang together, by their welded vertices.
class Pieces {
public:
  explicit Pieces(std::size_t vertices) : parent_(vertices) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t of(std::uint32_t vertex) {
    while (parent_[vertex] != vertex)
      vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[of(a)] = of(b); }

private:
  std::vector<std::uint32_t> parent_;
};

struct Piece {
  glm::dvec3 low_m{std::numeric_limits<double>::infinity()}, high_m{-low_m};
  bool convex = true;
  std::vector<glm::dvec3> vertices_m;
  std::optional<PlaceSet> asked; // the same, once planes ask about them

  // Of float vertices, along each axis.
  double rounding_m() const { return 0x1p-22 * glm::length(high_m - low_m); }
};

class Mesh {
public:
  explicit Mesh(const Scene &scene)
      : scene_(scene), first_(first_at_same_place(scene.positions_m)), joined_(scene.positions_m.size()) {
    for (std::uint32_t id = 0; id < scene.triangles.size(); ++id)
      add(id);
    collect_vertices();
    check_edges();
    check_planes();
  }

  std::vector<std::uint32_t> bodies() {
    std::vector<std::uint32_t> bodies(scene_.triangles.size(), no_id);
    for (const std::uint32_t id : ids_)
      if (piece_of(id).convex)
        bodies[id] = joined_.of(corner(id, 0));
    return bodies;
  }

private:
  std::uint32_t corner(std::uint32_t id, std::uint32_t k) const {
    return first_[scene_.triangles[id].vertices[k % 3]];
  }
  const glm::dvec3 &place(std::uint32_t id, std::uint32_t k) const {
    return scene_.positions_m[corner(id, k)];
  }
  Piece &piece_of(std::uint32_t id) { return pieces_[joined_.of(corner(id, 0))]; }

  // Triangles of two corners are seams' leftovers; their two edges cancel.
  void add(std::uint32_t id) {
    const std::uint32_t a = corner(id, 0), b = corner(id, 1), c = corner(id, 2);
    if (a == b || b == c || c == a)
      return;
    ids_.push_back(id);
    joined_.join(a, b);
    joined_.join(b, c);
  }

  void collect_vertices() {
    std::vector<bool> used(scene_.positions_m.size());
    for (const std::uint32_t id : ids_) {
      Piece &piece = piece_of(id);
      const auto &paint = scene_.surfaces[scene_.triangles[id].surface].paint;
      piece.convex = piece.convex && !(paint && paint->alpha_cutoff > 0.0);
      for (std::uint32_t k = 0; k < 3; ++k) {
        piece.low_m = glm::min(piece.low_m, place(id, k));
        piece.high_m = glm::max(piece.high_m, place(id, k));
        if (!used[corner(id, k)])
          piece.vertices_m.push_back(place(id, k));
        used[corner(id, k)] = true;
      }
    }
  }

  // Closed where each edge is that of two triangles that run along it in opposite directions; not convex
  // where one of them rises over the other, which is seen quickly.
  void check_edges() {
    const std::vector<WeldedEdge> edges = welded_edges(scene_, ids_, first_);
    for (std::size_t i = 0; i < edges.size();) {
      std::size_t end = i + 1;
      while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high)
        ++end;
      Piece &piece = piece_of(edges[i].triangle);
      piece.convex = piece.convex && end == i + 2 && are_convex(edges[i], edges[i + 1], piece.rounding_m());
      i = end;
    }
  }

  // Convex where no vertex rises over any triangle.
  void check_planes() {
    for (const std::uint32_t id : ids_) {
      Piece &piece = piece_of(id);
      if (!piece.convex)
        continue;
      if (!piece.asked)
        piece.asked.emplace(piece.vertices_m);
      const auto plane = front_plane({place(id, 0), place(id, 1), place(id, 2)});
      piece.convex = plane && !piece.asked->any_above(*plane, piece.rounding_m());
    }
  }

  bool are_convex(const WeldedEdge &a, const WeldedEdge &b, double rounding_m) const {
    if (corner(a.triangle, a.side) == corner(b.triangle, b.side))
      return false; // the same direction: one of the two is inside out
    return rises_m(a, b) <= rounding_m && rises_m(b, a) <= rounding_m;
  }

  // How far `other` rises over the plane of `edge`'s triangle.
  double rises_m(const WeldedEdge &edge, const WeldedEdge &other) const {
    const glm::dvec3 &a = place(edge.triangle, 0);
    const glm::dvec3 front = glm::cross(place(edge.triangle, 1) - a, place(edge.triangle, 2) - a);
    const double area = glm::length(front);
    if (!(area > 0.0))
      return std::numeric_limits<double>::infinity();
    return glm::dot(front, place(other.triangle, other.side + 2) - a) / area;
  }

  const Scene &scene_;
  std::vector<std::uint32_t> first_;
  Pieces joined_;
  std::unordered_map<std::uint32_t, Piece> pieces_; // by Pieces::of()
  std::vector<std::uint32_t> ids_;
};

} // namespace

std::vector<std::uint32_t> convex_bodies(const Scene &scene) { return Mesh(scene).bodies(); }

} // namespace pmdsim
