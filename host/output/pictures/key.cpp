#include "host/output/pictures/key.h"

#include "host/output/pictures/image.h"

#include <algorithm>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr double swatch = 14.0; // side of a colour's square

} // namespace

void draw_colour_bar(Canvas &canvas, const Box &box, const Axis &axis, const ColourMap &colours) {
  const glm::uvec2 resolution(1, static_cast<std::uint32_t>(box.height));
  const SurfacePtr ramp = make_image(resolution, [&](std::uint32_t, std::uint32_t row) {
    return colours.at(1.0 - (row + 0.5) / resolution.y);
  });
  canvas.image(ramp.get(), box);
  canvas.outline(box);
  canvas.right_axis(box, axis);
}

KeyEntry no_value_entry() { return {no_value_colour, "no value"}; }

void draw_entry(Canvas &canvas, double left, double y, const KeyEntry &entry) {
  const Box box{left, y - 0.5 * swatch, swatch, swatch};
  canvas.fill(box, entry.colour);
  canvas.outline(box);
  canvas.text(box.right() + 6.0, y, entry.text, Anchor::left);
}

double width_of(const std::vector<KeyEntry> &entries) {
  double widest = 0.0;
  for (const KeyEntry &entry : entries)
    widest = std::max(widest, swatch + 6.0 + text_width(entry.text));
  return widest;
}

std::string value_text(double value) {
  std::string text = fmt::format("{:.4g}", value + 0.0);
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos;)
    text.replace(at, 1, "−");
  return text;
}

} // namespace pmdsim
