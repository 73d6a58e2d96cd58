#pragma once
// The longest edges of a scene at which light may jump, and how directions of lines avoid them: an edge that
// all but lies in the plane of a line comes into sight along the whole of its length from one line to the
// next.

#include "engine/surfaces/elements.h"

#include <vector>

namespace pmdsim {

class SharpEdges {
public:
  explicit SharpEdges(const Elements &elements, const Scene &scene);

  // Of some turns of the axis of so many lines, as SurfaceFrame takes them, that which is least along the
  // edges; they are `turn` and others, spread evenly.
  double best_turn(const SurfacePlace &place, double turn, std::uint32_t lines) const;

private:
  struct Edge {
    glm::vec3 a, b; // from the elements' origin
  };

  std::vector<Edge> edges_;
};

} // namespace pmdsim
