#pragma once
// What a place on a surface sees of the scene around it, along lines over its hemisphere: half planes about
// an axis in the surface, at equal angles. In each, a triangle is a straight stretch, so that what hides what
// is known for each direction of a line at once, where rays are samples of it (N. Billen and P. Dutré, "Line
// sampling for direct illumination", Computer Graphics Forum 35, 2016).

#include "engine/surfaces/facet_cells.h"
#include "engine/surfaces/scan_board.h"
#include "engine/surfaces/sharp_edges.h"
#include "engine/surfaces/surface_frame.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

namespace pmdsim {

class HemisphereScan {
public:
  // Lines have so many bins, 16 to most_bins, rounded up to a multiple of 16. The scene has to outlive this;
  // the facets have to be cut by then.
  HemisphereScan(const Scene &scene, const Elements &elements, std::uint32_t bins);
  HemisphereScan(const HemisphereScan &) = delete;
  HemisphereScan &operator=(const HemisphereScan &) = delete;

  // The frame in which a place is to be looked from along so many lines. Its x, their axis, is chosen near
  // `turn`, 0 to 1, which should be another for each place: then what lines leave out at one has nothing to
  // do with what they leave out at the next.
  SurfaceFrame frame(const SurfacePlace &place, double turn, std::uint32_t lines) const;

  // Looks along so many lines; calls visit(line) for each, in the order of their angles. Any number of
  // threads may call this at once.
  void at(const SurfaceFrame &frame, std::uint32_t lines,
          const std::function<void(const SeenLine &)> &visit) const;

private:
  friend class PlaceScan;
  void make_bins(std::uint32_t bins);

  SharpEdges edges_;
  std::vector<float> x_m_, y_m_, z_m_; // vertices, from the elements' origin
  std::array<std::vector<std::int32_t>, 3> corners_;
  std::vector<std::uint32_t> triangles_; // of the scene, by number
  FacetCells cells_;
  std::vector<float> bin_x_, bin_y_, bin_cotangent_;
  std::vector<std::uint8_t> is_masked_;
  struct Cutouts {
    const Scene &scene;
    const std::vector<std::uint32_t> &triangles;
  } cutouts_;
  ScanScene board_{};
  const ScanLoops &loops_;
};

// A turn of lines for the place with that number, far from those of its neighbours (the golden ratio's
// sequence).
inline double turn_of(std::uint64_t number) {
  const double turns = std::numbers::phi * static_cast<double>(number % 1'000'003);
  return turns - std::floor(turns);
}

} // namespace pmdsim
