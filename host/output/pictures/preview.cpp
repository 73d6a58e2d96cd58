#include "host/output/pictures/preview.h"

#include "engine/model/scene.h"
#include "host/output/pictures/image.h"
#include "host/output/pictures/key.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace pmdsim {
namespace {

// Pixel centres lie on whole numbers, and only these have ticks: a frame of three columns has no column 0.5.
Axis pixel_axis(std::uint32_t count, double length) {
  const int fitting = std::clamp(static_cast<int>(length / 50.0), 1, 8);
  return make_axis({-0.5, count - 0.5}, std::min(fitting, std::max(1, static_cast<int>(count))));
}

// The vertical axis with row 0 at the top.
Axis upside_down(Axis axis) {
  std::swap(axis.range.min, axis.range.max);
  return axis;
}

struct Layout {
  Axis rows, columns;
  Box image, key; // the key is the colour bar, or a list, with room for its title above
  int width, height;
};

// Of an image of this size that shows `resolution` pixels; `key_width` is what the key takes, its title and
// labels included.
Layout lay_out(const glm::uvec2 &size, const glm::uvec2 &resolution, double title_width, double key_width) {
  constexpr double margin = 16.0, top = 64.0, bottom = 58.0, gap = 26.0, bar_width = 18.0,
                   least_height = 220.0;
  const Axis rows = pixel_axis(resolution.y, size.y), columns = pixel_axis(resolution.x, size.x);
  const double left = margin + text_size + 8.0 + label_width(rows) + 10.0;
  const Box box{std::round(left), top, static_cast<double>(size.x), static_cast<double>(size.y)};
  const Box key{box.right() + gap, top, bar_width, std::max(box.height, least_height)};
  const double right = std::max(key.left + std::max(key_width, 100.0), box.left + title_width);
  return {rows, columns, box, key, static_cast<int>(right + margin), static_cast<int>(key.bottom() + bottom)};
}

// All but the key.
Canvas draw_image(const Layout &layout, cairo_surface_t *image, const std::string &title) {
  Canvas canvas(layout.width, layout.height);
  const Box &box = layout.image;
  canvas.title(box.left, 22.0, title);
  canvas.image(image, box);
  canvas.outline(box);
  canvas.bottom_axis(box, layout.columns);
  canvas.left_axis(box, upside_down(layout.rows));
  canvas.text(box.left + 0.5 * box.width, box.bottom() + 36.0, "column", Anchor::centre);
  canvas.vertical_text(box.left - label_width(layout.rows) - 24.0, box.top + 0.5 * box.height, "row");
  return canvas;
}

// Below the key's title, from the top.
void draw_entries(Canvas &canvas, const Layout &layout, const std::vector<KeyEntry> &entries) {
  double y = layout.key.top + key_line_height / 3.0;
  for (const KeyEntry &entry : entries) {
    draw_entry(canvas, layout.key.left, y, entry);
    y += key_line_height;
  }
}

double title_width_of(const std::string &title) { return text_width(title, title_size) * 1.15; }

bool has_gaps(const PreviewImage &image) {
  return !std::ranges::all_of(image.values, [](float value) { return std::isfinite(value); });
}

// What stands in place of a bar that would say nothing.
std::vector<KeyEntry> entries_of_constant(const ValueSpread &spread, const Colouring &colouring,
                                          const std::string &unit, bool gaps) {
  std::vector<KeyEntry> entries;
  if (!spread.is_empty()) {
    const double value = 0.5 * (spread.least + spread.greatest);
    entries.push_back({colouring.at(value),
                       fmt::format("constant {}{}{}", value_text(value), unit.empty() ? "" : " ", unit)});
  }
  if (gaps)
    entries.push_back(no_value_entry());
  return entries;
}

// "3 Cube"; of a long name its beginning, cut between letters of UTF-8.
std::string id_text(std::uint32_t id, std::span<const std::string> names) {
  constexpr std::size_t longest = 32;
  if (id >= names.size())
    return fmt::format("{}", id);
  std::string name = names[id];
  if (name.size() > longest) {
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0u) == 0x80u)
      --end;
    name = name.substr(0, end) + "...";
  }
  return fmt::format("{} {}", id, name);
}

// The ids that most pixels show, the most frequent first; then how many more there are.
std::vector<KeyEntry> entries_of_ids(std::span<const std::uint32_t> ids, std::span<const std::string> names,
                                     std::size_t fitting) {
  std::map<std::uint32_t, std::size_t> counts;
  for (const std::uint32_t id : ids)
    ++counts[id];
  const bool gaps = counts.erase(no_id) > 0;
  std::vector<std::pair<std::uint32_t, std::size_t>> by_count(counts.begin(), counts.end());
  std::ranges::stable_sort(by_count, std::ranges::greater(), &std::pair<std::uint32_t, std::size_t>::second);
  const std::size_t room = fitting - (gaps ? 1 : 0);
  const std::size_t shown = by_count.size() <= room ? by_count.size() : room - 1;
  std::vector<KeyEntry> entries;
  for (std::size_t i = 0; i < shown; ++i)
    entries.push_back({colour_of_id(by_count[i].first), id_text(by_count[i].first, names)});
  if (shown < by_count.size())
    entries.push_back({white, fmt::format("{} more", by_count.size() - shown)});
  if (gaps)
    entries.push_back(no_value_entry());
  return entries;
}

// A picture whose key is a list.
Canvas with_list(cairo_surface_t *pixels, const glm::uvec2 &size, const glm::uvec2 &resolution,
                 const std::vector<KeyEntry> &entries, const std::string &key_title,
                 const std::string &title) {
  const Layout layout =
      lay_out(size, resolution, title_width_of(title), std::max(width_of(entries), text_width(key_title)));
  Canvas canvas = draw_image(layout, pixels, title);
  canvas.text(layout.key.left, layout.key.top - 16.0, key_title, Anchor::left);
  draw_entries(canvas, layout, entries);
  return canvas;
}

} // namespace

Canvas draw_preview(const PreviewImage &image, const Colouring &colouring, const glm::uvec2 &resolution,
                    const std::string &quantity, const std::string &unit, const std::string &title) {
  const Axis axis = make_axis(colouring.range, 8);
  const std::string key_title = axis_title(quantity, unit, axis.exponent);
  const Layout layout = lay_out(image.resolution * image.enlargement, resolution, title_width_of(title),
                                std::max(text_width(key_title), 28.0 + label_width(axis)));
  const SurfacePtr pixels = coloured(image, colouring);
  Canvas canvas = draw_image(layout, pixels.get(), title);
  canvas.text(layout.key.left, layout.key.top - 16.0, key_title, Anchor::left);
  draw_colour_bar(canvas, layout.key, axis, *colouring.colours);
  if (has_gaps(image))
    draw_entry(canvas, layout.key.left, layout.key.bottom() + key_line_height, no_value_entry());
  return canvas;
}

Canvas draw_preview(std::span<const float> values, const glm::uvec2 &resolution, const Preview &preview,
                    const std::string &unit, const std::string &title) {
  const PreviewImage image = preview_image(values, resolution, preview.scale);
  const ValueSpread spread = spread_of_values(image.values);
  const Colouring colouring = colouring_of(spread, preview.scale);
  const bool is_fixed = preview.scale == ColourScale::turn || preview.scale == ColourScale::share;
  const std::string quantity(preview.quantity);
  if (!spread.is_empty() && (is_fixed || !spread.is_constant()))
    return draw_preview(image, colouring, resolution, quantity, unit, title);
  const SurfacePtr pixels = coloured(image, colouring);
  return with_list(pixels.get(), image.resolution * image.enlargement, resolution,
                   entries_of_constant(spread, colouring, unit, has_gaps(image)), quantity, title);
}

Canvas draw_preview(std::span<const std::uint32_t> ids, const glm::uvec2 &resolution,
                    const std::string &title, std::span<const std::string> names) {
  const std::uint32_t block =
      (std::max(resolution.x, resolution.y) + max_preview_side - 1) / max_preview_side;
  const glm::uvec2 shrunk = (resolution + block - 1u) / block;
  const SurfacePtr pixels = make_image(shrunk, [&](std::uint32_t column, std::uint32_t row) {
    const std::uint32_t id = ids[std::size_t{row} * block * resolution.x + std::size_t{column} * block];
    return id == no_id ? no_value_colour : colour_of_id(id);
  });
  return with_list(pixels.get(), shrunk * enlargement_of(resolution), resolution,
                   entries_of_ids(ids, names, 10), "id", title);
}

} // namespace pmdsim
