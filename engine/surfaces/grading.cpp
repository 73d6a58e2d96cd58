#include "engine/surfaces/grading.h"

#include "engine/surfaces/surface_frame.h"

#include <algorithm>
#include <numeric>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

constexpr int most_cuts = 5, near_cuts = 2; // of an element, each to half its size
constexpr double nearest = 0.8; // an element's size over the harmonic mean of the distances around it

// Directions over the hemisphere that stand for equal shares of what arrives: a spiral over the disc below.
constexpr std::size_t directions = 3 * packet_rays;

// What surrounds a place.
struct Surroundings {
  double per_m; // mean of 1 / distance
  bool is_open; // some of it may light the place: sides that reflect, or the open
};

class Grader {
public:
  Grader(const Scene &scene, const FacetTree &tree, Elements &elements)
      : scene_(scene), tree_(tree), elements_(elements) {
    for (const Facet &facet : elements.facets)
      for (const std::uint32_t element : facet.elements)
        reflects_.push_back(element != no_element ? 1 : 0);
  }

  void run() {
    std::vector<std::uint32_t> fresh(elements_.facets.size());
    std::iota(fresh.begin(), fresh.end(), 0u);
    for (int cut = 0; cut < most_cuts && !fresh.empty(); ++cut) {
      std::vector<std::uint8_t> is_rough(fresh.size());
      tbb::parallel_for(std::size_t{0}, fresh.size(), [&](std::size_t i) {
        is_rough[i] = is_too_large(elements_.facets[fresh[i]], cut < near_cuts) ? 1 : 0;
      });
      std::vector<std::uint32_t> rough;
      for (std::size_t i = 0; i < fresh.size(); ++i)
        if (is_rough[i] != 0)
          rough.push_back(fresh[i]);
      fresh = split_elements(scene_, elements_, rough);
    }
  }

private:
  Surroundings around(const SurfacePlace &place) const {
    const SurfaceFrame frame(place, 0.0);
    Surroundings found{0.0, false};
    for (std::size_t first = 0; first < directions; first += packet_rays) {
      RayPacket packet;
      for (std::size_t i = 0; i < packet_rays; ++i) {
        const double number = static_cast<double>(first + i), part = (number + 0.5) / directions,
                     angle = 2.0 * std::numbers::pi * std::numbers::phi * number;
        packet.directions[i] =
            glm::vec3(std::sqrt(part) * (std::cos(angle) * frame.x + std::sin(angle) * frame.y) +
                      std::sqrt(1.0 - part) * frame.z);
      }
      tree_.trace(place.position_m + elements_.clearance_m() * place.normal, packet);
      for (std::size_t i = 0; i < packet_rays; ++i) {
        if (packet.facet[i] != no_facet)
          found.per_m += 1.0 / (static_cast<double>(packet.length_m[i]) * directions);
        if (packet.facet[i] == no_facet || reflects_[face_of(packet.facet[i], packet.side[i])] != 0)
          found.is_open = true;
      }
    }
    return found;
  }

  bool is_too_large(const Facet &facet, bool near_counts) const {
    const double size_m = std::sqrt(2.0 * facet.area_m2());
    for (std::size_t side = 0; side < 2 && !facet.whole; ++side) {
      if (facet.elements[side] == no_element)
        continue;
      std::size_t open = 0;
      bool is_near = false;
      const auto places = places_of(facet, side);
      for (const SurfacePlace &place : places) {
        const Surroundings found = around(place);
        open += found.is_open ? 1 : 0;
        is_near = is_near || (found.is_open && size_m * found.per_m > nearest);
      }
      if ((open > 0 && open < places.size()) || (near_counts && is_near))
        return true;
    }
    return false;
  }

  const Scene &scene_;
  const FacetTree &tree_;
  Elements &elements_;
  std::vector<std::uint8_t> reflects_; // each face of the tree
};

} // namespace

void grade_elements(const Scene &scene, const FacetTree &tree, Elements &elements) {
  Grader(scene, tree, elements).run();
}

} // namespace pmdsim
