#pragma once
// Which colour stands for which value of a channel.

#include "engine/model/channels.h"
#include "host/output/pictures/axis.h"
#include "host/output/pictures/colour_map.h"

#include <limits>
#include <span>

namespace pmdsim {

// Where the finite values of a channel lie; empty, `least` above `greatest`, where there are none.
struct ValueSpread {
  double least = std::numeric_limits<double>::infinity(); // of all
  double greatest = -std::numeric_limits<double>::infinity();
  Range robust{0.0, 1.0}; // of all but the outermost 0.5 % on either side

  bool is_empty() const { return least > greatest; }
  // All are the same, as far as float32 can tell after some arithmetic.
  bool is_constant() const;
};

// NaN and infinities are no values.
ValueSpread spread_of_values(std::span<const float> values);
// Of several images that shall have the same colours: the hull of their ranges.
ValueSpread hull(const ValueSpread &a, const ValueSpread &b);

struct Colouring {
  const ColourMap *colours;
  Range range; // the values that the ends of the map stand for; of positive span

  Colour at(double value) const;
};

// For a `zero_centred` channel the map has its white at zero, unless all values are of one sign and closer to
// each other than to zero: then it shows their differences, as for a `sequential` one.
Colouring colouring_of(const ValueSpread &values, ColourScale scale);

// Twelve colours that are easy to tell apart, then the same in other shades.
Colour colour_of_id(std::uint32_t id);

} // namespace pmdsim
