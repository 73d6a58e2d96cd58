#pragma once
// Colours for numbers: perceptually even maps, interpolated between anchors.

#include <array>
#include <cstddef>

namespace pmdsim {

using Colour = std::array<double, 3>; // sRGB, 0 to 1

struct ColourMap {
  static constexpr std::size_t anchors = 17;
  std::array<std::array<double, anchors>, 3> levels; // red, green and blue, evenly spaced over [0, 1]

  // `position` from 0 to 1; beyond is clamped.
  Colour at(double position) const;
};

// Dark to light, for quantities that grow from a minimum. matplotlib's viridis (CC0).
extern const ColourMap viridis;
// Both ends alike, for angles. matplotlib's twilight (CC0).
extern const ColourMap twilight;
// Blue below, near white in the middle, red above, for signed quantities. Our own: even steps of Oklab
// lightness, equal on both sides.
extern const ColourMap blue_white_red;

// Grey that no map holds: pixels without a value.
inline constexpr Colour no_value_colour{0.55, 0.55, 0.55};

} // namespace pmdsim
