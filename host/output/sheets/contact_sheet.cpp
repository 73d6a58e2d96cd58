#include "host/output/sheets/contact_sheet.h"

#include "host/output/pictures/key.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr double margin = 16.0, top = 64.0, cell_gap = 10.0, label_height = 22.0, bar_width = 18.0;
constexpr std::uint32_t cell_side = 160; // at least, but for images that are small by a fraction
constexpr double widest = 1100.0;        // of all cells

struct Grid {
  std::uint32_t columns, rows;
  double width, height; // of an image

  Box cell(std::size_t index) const {
    const std::size_t row_number = index / columns;
    const auto column = static_cast<double>(index % columns), row = static_cast<double>(row_number);
    return {margin + column * (width + cell_gap), top + row * (height + label_height + cell_gap), width,
            height};
  }
  double right() const { return margin + columns * (width + cell_gap) - cell_gap; }
  double bottom() const { return top + rows * (height + label_height + cell_gap); }
};

// About as wide as high, or a little wider.
Grid grid_of(const FilmStrip &strip) {
  const glm::uvec2 size = strip.thumbnails.front().image.resolution;
  const std::uint32_t enlargement = std::max(1u, cell_side / std::max(size.x, size.y));
  const double width = size.x * enlargement, height = size.y * enlargement;
  const auto count = static_cast<double>(strip.frames.size());
  const double wanted =
      std::ceil(std::sqrt(1.4 * count * (height + label_height + cell_gap) / (width + cell_gap)));
  const double fitting = std::max(1.0, std::floor(widest / (width + cell_gap)));
  const double columns = std::min({wanted, fitting, count});
  return {static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(std::ceil(count / columns)), width,
          height};
}

std::string title_of(const FilmStrip &strip, std::uint32_t frame_count) {
  const std::size_t shown = strip.frames.size();
  return fmt::format("{}, {}, {}", strip.thumbnails.front().quantity, strip.sensor,
                     shown == frame_count ? fmt::format("{} frames", shown)
                                          : fmt::format("{} of {} frames", shown, frame_count));
}

bool has_gaps(const FilmStrip &strip) {
  return std::ranges::any_of(strip.thumbnails, [](const Thumbnail &thumbnail) {
    return std::ranges::any_of(thumbnail.image.values, [](float value) { return std::isnan(value); });
  });
}

} // namespace

Colouring colouring_of(const FilmStrip &strip) {
  ValueSpread all;
  for (const Thumbnail &thumbnail : strip.thumbnails)
    all = hull(all, spread_of_values(thumbnail.image.values));
  return colouring_of(all, strip.thumbnails.front().scale);
}

Canvas draw_contact_sheet(const FilmStrip &strip, std::uint32_t frame_count) {
  const Grid grid = grid_of(strip);
  const Colouring colouring = colouring_of(strip);
  const Axis axis = make_axis(colouring.range, 8);
  const std::string key_title =
      axis_title(strip.thumbnails.front().quantity, strip.thumbnails.front().unit, axis.exponent);
  const std::string title = title_of(strip, frame_count);
  constexpr double least_bar_height = 160.0;
  const Box bar{grid.right() + 26.0, top, bar_width,
                std::max(grid.bottom() - top - label_height - cell_gap, least_bar_height)};
  const double right = std::max({bar.left + text_width(key_title), bar.right() + 10.0 + label_width(axis),
                                 bar.left + 100.0, margin + 1.15 * text_width(title, title_size)});
  Canvas canvas(static_cast<int>(right + margin), static_cast<int>(bar.bottom() + 2.0 * key_line_height));
  canvas.title(margin, 22.0, title);
  for (std::size_t i = 0; i < strip.frames.size(); ++i) {
    const Box box = grid.cell(i);
    const SurfacePtr pixels = coloured(strip.thumbnails[i].image, colouring);
    canvas.image(pixels.get(), box);
    canvas.outline(box);
    canvas.text(box.left, box.bottom() + 0.5 * label_height, fmt::format("frame {}", strip.frames[i]),
                Anchor::left);
  }
  draw_colour_bar(canvas, bar, axis, *colouring.colours);
  canvas.text(bar.left, bar.top - 16.0, key_title, Anchor::left);
  if (has_gaps(strip))
    draw_entry(canvas, bar.left, bar.bottom() + key_line_height, no_value_entry());
  return canvas;
}

} // namespace pmdsim
