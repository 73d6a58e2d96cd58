#pragma once
// Which facet a place of a triangle lies in, told by cells that cover the triangle: most lie in one facet,
// for the others the cuts between facets are followed from there on.

#include "engine/surfaces/elements.h"
#include "engine/surfaces/scan_board.h"

#include <cstdint>
#include <vector>

namespace pmdsim {

class FacetCells {
public:
  // The facets have to be cut by then. Takes the triangles of the scene in that order.
  FacetCells(const Elements &elements, const std::vector<std::uint32_t> &triangles);

  // Points to what this holds.
  void show(ScanScene &scene) const;

private:
  // A node, and its corners as weights of its triangle's.
  struct Place {
    std::uint32_t node;
    glm::dmat3 corners;
  };

  void add_cuts(const Elements &elements, std::uint32_t root);
  void add_cells(const Elements &elements, std::uint32_t root);
  std::int32_t cell_at(const Elements &elements, std::uint32_t root, float u, float v, int most_cuts) const;

  std::vector<FacetCut> cuts_; // of each node
  std::vector<std::int32_t> first_cell_, cells_along_, cells_;
};

} // namespace pmdsim
