#pragma once
// Where a straight stretch of a triangle runs from one of its facets into the next.

#include "engine/surfaces/elements.h"

#include <array>
#include <cstdint>
#include <vector>

namespace pmdsim {

// at + t * way.
struct Linear {
  float at, way;
  float operator()(float t) const { return at + t * way; }
};

class FacetCuts {
public:
  // The facets have to be cut by then.
  explicit FacetCuts(const Elements &elements);

  // Along the stretch of a triangle, t from 0 to 1, on which its second and third corner weigh u and v: calls
  // visit(facet, from, to, u in the facet, v in the facet), in order.
  template <class Visit>
  void along(std::uint32_t triangle, const Linear &u, const Linear &v, const Visit &visit) const {
    struct Rest {
      std::uint32_t node;
      float to;
    };
    std::array<Rest, most_depth> rest;
    std::size_t left = 0;
    Rest now{roots_[triangle], 1.0f};
    float from = 0.0f;
    while (true) {
      const Cut cut = cuts_[now.node];
      if ((cut.next & leaf) != 0) {
        const std::uint32_t facet = cut.next & ~leaf;
        visit(facet, from, now.to, places_[facet].u(u, v), places_[facet].v(u, v));
        if (left == 0)
          return;
        from = now.to;
        now = rest[--left];
        continue;
      }
      const Linear side = cut.side(u, v);
      const float at_from = side(from), at_to = side(now.to);
      if (at_from * at_to < 0.0f && left < most_depth) {
        rest[left++] = {cut.next + (at_to > 0.0f ? 0u : 1u), now.to};
        now = {cut.next + (at_from > 0.0f ? 0u : 1u), from + (now.to - from) * at_from / (at_from - at_to)};
      } else {
        now.node = cut.next + (at_from + at_to >= 0.0f ? 0u : 1u);
      }
    }
  }

private:
  static constexpr std::size_t most_depth = 64; // of nodes: each halves an area
  static constexpr std::uint32_t leaf = 0x80000000u;

  // Linear in a triangle's second and third corner's weights.
  struct Plane {
    float at, u, v;
    Linear operator()(const Linear &of_u, const Linear &of_v) const {
      return {at + u * of_u.at + v * of_v.at, u * of_u.way + v * of_v.way};
    }
  };
  struct Cut {
    Plane side;         // positive in the first half
    std::uint32_t next; // the first half; of a leaf its facet
  };
  struct Place {
    Plane u, v;
  };

  // A node that waits, and its corners as weights of its triangle's.
  struct Open {
    std::uint32_t node;
    glm::dmat3 corners;
  };

  std::vector<std::uint32_t> roots_; // of each triangle of the scene
  std::vector<Cut> cuts_;            // of each node
  std::vector<Place> places_;        // in each facet
};

} // namespace pmdsim
