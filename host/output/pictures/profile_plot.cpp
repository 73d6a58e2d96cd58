#include "host/output/pictures/plots.h"

#include "host/output/tables/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

constexpr int plot_width = 900, plot_height = 500;
constexpr Colour line_colour{0.12, 0.38, 0.68};

// A tenth of room above and below; a constant line gets a range about its value.
Range value_range(std::span<const float> values) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const float value : values)
    if (std::isfinite(value))
      range = {std::min(range.min, static_cast<double>(value)),
               std::max(range.max, static_cast<double>(value))};
  if (range.span() < 0.0)
    return {0.0, 1.0};
  const double largest = std::max(std::abs(range.min), std::abs(range.max));
  const double room = std::max(0.1 * range.span(), largest > 0.0 ? 1e-4 * largest : 1.0);
  return {range.min - room, range.max + room};
}

// A pixel whose neighbours hold no value would vanish as a line, so every run starts with a dot.
void draw_line(Canvas &canvas, const Box &box, const Axis &columns, const Axis &axis,
               std::span<const float> values) {
  cairo_t *context = canvas.context();
  cairo_set_source_rgb(context, line_colour[0], line_colour[1], line_colour[2]);
  cairo_set_line_width(context, 2.0);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
  bool in_run = false;
  for (std::size_t column = 0; column < values.size(); ++column) {
    const bool has_value = std::isfinite(values[column]);
    if (has_value) {
      const double x = box.left + along(columns.range, static_cast<double>(column), box.width);
      const double y = box.bottom() - along(axis.range, static_cast<double>(values[column]), box.height);
      if (!in_run)
        cairo_move_to(context, x, y);
      cairo_line_to(context, x, y);
    }
    in_run = has_value;
  }
  cairo_stroke(context);
}

} // namespace

Canvas draw_profile(std::span<const float> values, const glm::uvec2 &resolution, const std::string &quantity,
                    const std::string &unit, const std::string &title) {
  const std::span<const float> row =
      values.subspan(std::size_t{profile_row(resolution)} * resolution.x, resolution.x);
  const Axis axis = make_axis(value_range(row), 8);
  const Axis columns =
      make_axis({-0.5, resolution.x - 0.5}, std::clamp(static_cast<int>(resolution.x), 2, 11));

  Canvas canvas(plot_width, plot_height);
  const Box box = plot_box(plot_width, plot_height, 48.0, axis);
  canvas.title(box.left, 24.0, title);
  canvas.grid(box, columns, axis, {0.55, 0.55, 0.55});
  draw_line(canvas, box, columns, axis, row);
  canvas.frame(box, columns, axis, "column", axis_title(quantity, unit, axis.exponent));
  if (std::none_of(row.begin(), row.end(), [](float value) { return std::isfinite(value); }))
    canvas.text(box.left + 0.5 * box.width, box.top + 0.5 * box.height, "no value in this row",
                Anchor::centre);
  return canvas;
}

} // namespace pmdsim
