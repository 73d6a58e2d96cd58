#pragma once
// How light bounces between elements: rays from each place of each element, each of which stands for the same
// share of what arrives there, and what they meet. All tones and all bounces share them.

#include "engine/radiosity/bounce_tones.h"
#include "engine/radiosity/exitance.h"
#include "engine/radiosity/facet_tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace pmdsim {

class Exchange {
public:
  // Casts `rays_per_edge` squared rays from each place; a multiple of 4.
  Exchange(const Elements &elements, const FacetTree &tree, std::uint32_t rays_per_edge);

  std::size_t rays() const { return meetings_.size(); }

  // Turns the following products into those of a tone.
  void set_tone(const BounceTone &tone);
  // What arrives at the places of all elements, in order, of light that leaves faces, whose values at the
  // corners are given: W/m^2 both.
  void arrive(std::span<const std::array<Phasor, 3>> faces, std::span<Phasor> places) const;

private:
  struct Meeting {
    std::uint32_t face; // or no_facet: the ray meets nothing, or a side that is dark
    float u, v, length_m;
  };

  std::size_t per_place_;
  std::vector<Meeting> meetings_;
  std::vector<Phasor> turns_; // of the ways of rays, of the tone
};

} // namespace pmdsim
