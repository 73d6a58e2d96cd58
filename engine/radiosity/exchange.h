#pragma once
// How light bounces between elements: what each place of each element sees of the others, along lines. All
// tones and all bounces share it.

#include "engine/radiosity/bounce_tones.h"
#include "engine/radiosity/exitance.h"
#include "engine/surfaces/hemisphere_scan.h"

#include <cstdint>
#include <span>
#include <vector>

namespace pmdsim {

class Exchange {
public:
  // Looks along so many lines from each place.
  Exchange(const Elements &elements, const HemisphereScan &scan, std::uint32_t lines);

  // Turns the following products into those of a tone.
  void set_tone(const BounceTone &tone);
  // What arrives at the places of all elements, in order, of light that leaves faces, whose values at the
  // corners are given: W/m^2 both.
  void arrive(std::span<const std::array<Phasor, 3>> faces, std::span<Phasor> places) const;

private:
  struct Meeting {
    std::uint32_t face;
    float u, v, length_m, share;
    Phasor way; // of the tone: the share, turned by the length
  };

  std::vector<std::vector<Meeting>> of_places_;
};

} // namespace pmdsim
