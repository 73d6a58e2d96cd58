#include "engine/surfaces/sharp_edges.h"

#include "engine/surfaces/surface_frame.h"

#include <algorithm>
#include <array>
#include <map>

namespace pmdsim {
namespace {

constexpr std::size_t most_edges = 40; // more cost more than they gain
constexpr std::size_t turns = 8;       // that are tried

// The ends of an edge, in an order that does not depend on the triangle.
using EdgeKey = std::array<float, 6>;

EdgeKey key_of(const glm::vec3 &a, const glm::vec3 &b) {
  const std::array<float, 3> first{a.x, a.y, a.z}, second{b.x, b.y, b.z};
  return first < second ? EdgeKey{a.x, a.y, a.z, b.x, b.y, b.z} : EdgeKey{b.x, b.y, b.z, a.x, a.y, a.z};
}

// The part of the way from a to b that lies above the surface, whose heights are z.
bool clip(glm::vec3 &a, glm::vec3 &b) {
  if (a.z <= 0.0f && b.z <= 0.0f)
    return false;
  for (auto *low : {&a, &b})
    if (low->z < 0.0f) {
      *low = a + (a.z / (a.z - b.z)) * (b - a);
      low->z = 0.0f;
      break;
    }
  return glm::dot(a, a) > 0.0f && glm::dot(b, b) > 0.0f;
}

} // namespace

SharpEdges::SharpEdges(const Elements &elements, const Scene &scene) {
  struct Found {
    glm::dvec3 normal;
    bool is_flat; // two triangles of one plane share it
  };
  std::map<EdgeKey, Found> found;
  for (std::size_t id = 0; id < scene.triangles.size(); ++id) {
    if (elements.roots[id] == no_node)
      continue;
    const auto corner = [&](std::size_t i) {
      return scene.positions_m[scene.triangles[id].vertices[i % 3]] - elements.origin_m;
    };
    const glm::dvec3 normal = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [known, is_new] =
          found.try_emplace(key_of(glm::vec3(corner(i)), glm::vec3(corner(i + 1))), normal, false);
      constexpr double same_direction = 1.0 - 1e-6;
      if (!is_new && std::abs(glm::dot(known->second.normal, normal)) > same_direction)
        known->second.is_flat = true;
    }
  }
  for (const auto &[key, edge] : found)
    if (!edge.is_flat)
      edges_.push_back({{key[0], key[1], key[2]}, {key[3], key[4], key[5]}});
  std::ranges::stable_sort(edges_, std::greater(),
                           [](const Edge &edge) { return glm::distance(edge.a, edge.b); });
  edges_.resize(std::min(edges_.size(), most_edges));
}

double SharpEdges::best_turn(const SurfacePlace &place, double turn, std::uint32_t lines) const {
  const SurfaceFrame frame(place, 0.0);
  const glm::vec3 x(frame.x), y(frame.y), z(frame.z), from(frame.from_m);
  std::array<double, turns> tried;
  std::array<glm::vec2, turns> axes;
  for (std::size_t k = 0; k < turns; ++k) {
    tried[k] = turn + std::numbers::phi * static_cast<double>(k);
    tried[k] -= std::floor(tried[k]);
    axes[k] = glm::vec2(std::cos(std::numbers::pi * tried[k]), std::sin(std::numbers::pi * tried[k]));
  }
  const float between_lines = std::numbers::pi_v<float> / static_cast<float>(lines);
  std::array<float, turns> cost{};
  for (const Edge &edge : edges_) {
    const auto seen = [&](const glm::vec3 &end) {
      const glm::vec3 way = end - from;
      return glm::vec3(glm::dot(x, way), glm::dot(y, way), glm::dot(z, way));
    };
    glm::vec3 a = seen(edge.a), b = seen(edge.b);
    if (!clip(a, b))
      continue;
    const glm::vec3 to_a = glm::normalize(a), to_b = glm::normalize(b);
    const float length = glm::distance(to_a, to_b), weight = (to_a.z + to_b.z) * length * length;
    for (std::size_t k = 0; k < turns; ++k) {
      const auto line_angle = [&](const glm::vec3 &end) {
        return angle_of(axes[k].x * end.y - axes[k].y * end.x, end.z);
      };
      cost[k] += weight / (std::abs(line_angle(a) - line_angle(b)) + between_lines);
    }
  }
  return tried[static_cast<std::size_t>(std::ranges::min_element(cost) - cost.begin())];
}

} // namespace pmdsim
