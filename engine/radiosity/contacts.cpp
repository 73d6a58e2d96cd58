#include "engine/radiosity/contacts.h"

#include "engine/radiosity/exitance.h"
#include "engine/radiosity/surface_frame.h"

#include <algorithm>
#include <numeric>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

constexpr int most_cuts_at_contacts = 5; // of an element, each to half its size

// Directions over the hemisphere that stand for equal shares of what arrives: a spiral over the disc below.
constexpr std::size_t directions = 3 * packet_rays;

class ContactCutter {
public:
  ContactCutter(const Scene &scene, const FacetTree &tree, Elements &elements)
      : scene_(scene), tree_(tree), elements_(elements) {
    for (const Facet &facet : elements.facets)
      for (const std::uint32_t element : facet.elements)
        reflects_.push_back(element != no_element ? 1 : 0);
  }

  void run() {
    std::vector<std::uint32_t> fresh(elements_.facets.size());
    std::iota(fresh.begin(), fresh.end(), 0u);
    for (int cut = 0; cut < most_cuts_at_contacts && !fresh.empty(); ++cut) {
      std::vector<std::uint8_t> is_rough(fresh.size());
      tbb::parallel_for(std::size_t{0}, fresh.size(), [&](std::size_t i) {
        is_rough[i] = is_partly_open(elements_.facets[fresh[i]]) ? 1 : 0;
      });
      std::vector<std::uint32_t> rough;
      for (std::size_t i = 0; i < fresh.size(); ++i)
        if (is_rough[i] != 0)
          rough.push_back(fresh[i]);
      fresh = split_elements(scene_, elements_, rough);
    }
  }

private:
  // Whether anything around a place may light it: a side that reflects, or the open.
  bool is_open(const SurfacePlace &place) const {
    constexpr double golden = 0.61803398874989484820;
    const SurfaceFrame frame(place, 0.0);
    for (std::size_t first = 0; first < directions; first += packet_rays) {
      RayPacket packet;
      for (std::size_t i = 0; i < packet_rays; ++i) {
        const double number = static_cast<double>(first + i), part = (number + 0.5) / directions,
                     angle = 2.0 * std::numbers::pi * golden * number;
        packet.directions[i] =
            glm::vec3(std::sqrt(part) * (std::cos(angle) * frame.x + std::sin(angle) * frame.y) +
                      std::sqrt(1.0 - part) * frame.z);
      }
      tree_.trace(place.position_m + elements_.clearance_m() * place.normal, packet);
      for (std::size_t i = 0; i < packet_rays; ++i)
        if (packet.facet[i] == no_facet || reflects_[face_of(packet.facet[i], packet.side[i])] != 0)
          return true;
    }
    return false;
  }

  bool is_partly_open(const Facet &facet) const {
    for (std::size_t side = 0; side < 2 && !facet.whole; ++side) {
      if (facet.elements[side] == no_element)
        continue;
      const auto places = places_of(facet, side);
      const auto open =
          std::ranges::count_if(places, [&](const SurfacePlace &place) { return is_open(place); });
      if (open > 0 && open < std::ssize(places))
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

void cut_at_contacts(const Scene &scene, const FacetTree &tree, Elements &elements) {
  ContactCutter(scene, tree, elements).run();
}

} // namespace pmdsim
