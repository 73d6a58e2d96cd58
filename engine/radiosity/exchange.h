#pragma once
// How light bounces between elements: what arrives at each place of each element of what leaves the others,
// tone by tone. All bounces share it.

#include "engine/radiosity/bounce_tones.h"
#include "engine/radiosity/element_light.h"
#include "engine/radiosity/exitance.h"
#include "engine/surfaces/hemisphere_scan.h"

#include <cstdint>
#include <span>
#include <vector>

namespace pmdsim {

class OpenRow;

class Exchange {
public:
  // Looks along so many lines from each place. What arrives there directly from faces, of `direct`'s tones in
  // that order, is found on the way.
  // The layout has to outlive this.
  Exchange(const Elements &elements, const ElementLight &layout, const HemisphereScan &scan,
           std::uint32_t lines, const std::vector<BounceTone> &tones, const Exitance &direct);

  // W/m^2, the values at all places as ElementLight has them.
  const std::vector<Phasor> &first(std::size_t tone) const { return tones_[tone].first; }

  // The values of a tone's light that arrives on elements and bounces once, each face scattering the part
  // that it reflects.
  // Those at the elements' last places, from which nothing follows, are 0 unless they are asked for.
  std::vector<Phasor> bounced(std::size_t tone, std::span<const TriangleLight> elements,
                              bool with_last_places) const;

private:
  // How much each coefficient of an element's light counts in a value; of elements of which lines saw little,
  // how much its light in the middle counts.
  struct Near {
    std::uint32_t element;
    TriangleLight weights;
  };
  struct Far {
    std::uint32_t element;
    Phasor weight;
  };
  struct Row {
    std::vector<Near> near;
    std::vector<Far> far;
  };
  struct OfTone {
    std::vector<Phasor> first;
    std::vector<Row> values;
  };

  static void close(OpenRow &open, const Elements &elements, Row &row);

  const ElementLight &layout_;
  std::vector<OfTone> tones_;
};

} // namespace pmdsim
