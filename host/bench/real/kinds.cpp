#include "host/bench/real/kinds.h"

#include <algorithm>
#include <array>

namespace pmdsim {

std::span<const SceneKind> scene_kinds() {
  static constexpr std::array kinds{
      SceneKind{"blob", "a smooth body before a wall", false, blob},
      SceneKind{"knot", "a torus knot before a wall", false, knot},
      SceneKind{"scan", "a rough body with a scanner's noise before a wall", false, scan},
      SceneKind{"head", "a smooth head with hollows before a wall", false, head},
      SceneKind{"terrain", "hills", false, terrain},
      SceneKind{"lattice", "a lattice of rods before a wall", false, lattice},
      SceneKind{"blades", "grass before a wall", false, blades},
      SceneKind{"forest", "trunks, cones and loose leaves on a ground", false, forest},
      SceneKind{"colonnade", "fluted columns in a hall", false, colonnade},
      SceneKind{"crowd", "figures in poses of their own", false, crowd},
      SceneKind{"room", "furniture and balls", false, furnished},
      SceneKind{"soup", "separate triangles at random", true, soup},
      SceneKind{"fans", "many triangles on one edge", true, fans},
      SceneKind{"flipped", "a body half of whose triangles show their back", true, flipped},
      SceneKind{"touching", "bodies that touch and intersect", true, touching},
      SceneKind{"piercing", "rods through the plane of the lens and the diodes", true, piercing},
      SceneKind{"close", "a rough body 0.2 m before the diodes", true, close_body},
      SceneKind{"needles", "triangles of 2 m x 6 mm in all directions", true, needles}};
  return kinds;
}

const SceneKind *find_kind(std::string_view name) {
  const auto kinds = scene_kinds();
  const auto found = std::ranges::find(kinds, name, &SceneKind::name);
  return found == kinds.end() ? nullptr : &*found;
}

} // namespace pmdsim
