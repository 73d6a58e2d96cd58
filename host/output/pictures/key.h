#pragma once
// What the colours of a picture mean: a bar with ticks, or a list.

#include "host/output/pictures/canvas.h"
#include "host/output/pictures/colour_map.h"

#include <string>
#include <vector>

namespace pmdsim {

// The map from bottom to top, with the axis to its right.
void draw_colour_bar(Canvas &canvas, const Box &box, const Axis &axis, const ColourMap &colours);

// A line of a list: what a colour means.
struct KeyEntry {
  Colour colour;
  std::string text;
};

KeyEntry no_value_entry();
inline constexpr double key_line_height = 22.0;

// `y` is the line's middle.
void draw_entry(Canvas &canvas, double left, double y, const KeyEntry &entry);
// The widest of them.
double width_of(const std::vector<KeyEntry> &entries);

// A value for people: "2.632", "−1.5e−07".
std::string value_text(double value);

} // namespace pmdsim
