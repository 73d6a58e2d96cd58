#include "host/output/pictures/preview.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pmdsim {
namespace {

constexpr std::uint32_t max_side = 1024;
constexpr std::uint32_t enlarged_side = 512;

float block_mean(std::span<const float> values, const glm::uvec2 &resolution, const glm::uvec2 &first,
                 std::uint32_t block) {
  double sum = 0.0, count = 0.0;
  for (std::size_t row = first.y; row < std::min(first.y + block, resolution.y); ++row)
    for (std::size_t column = first.x; column < std::min(first.x + block, resolution.x); ++column)
      if (const float value = values[row * resolution.x + column]; std::isfinite(value)) {
        sum += static_cast<double>(value);
        ++count;
      }
  return static_cast<float>(sum / count);
}

// A constant image still gets a bar with some extent, but rounding noise is not blown up to a pattern.
Range widened(const Range &range) {
  const double largest = std::max(std::abs(range.min), std::abs(range.max));
  const double least_span = largest > 0.0 ? 1e-5 * largest : 1.0;
  if (range.span() >= least_span)
    return range;
  const double middle = 0.5 * (range.min + range.max);
  return {middle - 0.5 * least_span, middle + 0.5 * least_span};
}

// The range of all finite values but the outermost 0.5 % on either side.
Range robust_range(std::span<const float> values) {
  std::vector<float> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](float v) { return std::isfinite(v); });
  if (finite.empty())
    return {0.0, 1.0};
  const auto left_out = static_cast<std::ptrdiff_t>(finite.size() / 200);
  const auto low = finite.begin() + left_out;
  const auto high = finite.end() - 1 - left_out;
  std::nth_element(finite.begin(), low, finite.end());
  const auto min = static_cast<double>(*low);
  std::nth_element(finite.begin(), high, finite.end());
  return {min, static_cast<double>(*high)};
}

const ColourMap &colours_of(ColourScale scale) {
  return scale == ColourScale::turn           ? twilight
         : scale == ColourScale::zero_centred ? blue_white_red
                                              : viridis;
}

std::uint32_t rgb24(const Colour &colour) {
  const auto byte = [](double level) { return static_cast<std::uint32_t>(std::lround(255.0 * level)); };
  return byte(colour[0]) << 16 | byte(colour[1]) << 8 | byte(colour[2]);
}

template <typename ColourOfPixel>
SurfacePtr make_image(const glm::uvec2 &resolution, ColourOfPixel colour_of_pixel) {
  SurfacePtr surface = make_surface(static_cast<int>(resolution.x), static_cast<int>(resolution.y));
  unsigned char *bytes = cairo_image_surface_get_data(surface.get());
  const int stride_bytes = cairo_image_surface_get_stride(surface.get());
  for (std::uint32_t row = 0; row < resolution.y; ++row) {
    auto *pixels = reinterpret_cast<std::uint32_t *>(bytes + static_cast<std::ptrdiff_t>(row) * stride_bytes);
    for (std::uint32_t column = 0; column < resolution.x; ++column)
      pixels[column] = rgb24(colour_of_pixel(column, row));
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

void draw_colour_bar(Canvas &canvas, const Box &box, const Axis &axis, const ColourMap &colours) {
  const glm::uvec2 resolution(1, static_cast<std::uint32_t>(box.height));
  const SurfacePtr ramp = make_image(resolution, [&](std::uint32_t, std::uint32_t row) {
    return colours.at(1.0 - (row + 0.5) / resolution.y);
  });
  canvas.image(ramp.get(), box);
  canvas.outline(box);
  canvas.right_axis(box, axis);
}

void draw_no_value_legend(Canvas &canvas, double left, double y) {
  constexpr double swatch = 14.0;
  const Box box{left, y - 0.5 * swatch, swatch, swatch};
  canvas.fill(box, no_value_colour);
  canvas.outline(box);
  canvas.text(box.right() + 6.0, y, "no value", Anchor::left);
}

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
  Box image, bar;
  int width, height;
};

Layout lay_out(const PreviewImage &image, const Axis &values, const Axis &rows, double title_width,
               double bar_title_width) {
  constexpr double margin = 16.0, top = 64.0, bottom = 58.0, gap = 26.0, bar_width = 18.0,
                   least_height = 220.0;
  const double width = image.resolution.x * image.enlargement;
  const double height = image.resolution.y * image.enlargement;
  const double left = margin + text_size + 8.0 + label_width(rows) + 10.0;
  const Box box{std::round(left), top, width, height};
  const Box bar{box.right() + gap, top, bar_width, std::max(height, least_height)};
  const double bar_right = std::max(bar.right() + 10.0 + label_width(values), bar.left + bar_title_width);
  const double right = std::max({bar_right, bar.left + 100.0, box.left + title_width});
  return {box, bar, static_cast<int>(right + margin), static_cast<int>(bar.bottom() + bottom)};
}

} // namespace

PreviewImage preview_image(std::span<const float> values, const glm::uvec2 &resolution, ColourScale scale) {
  const std::uint32_t side = std::max(resolution.x, resolution.y);
  const std::uint32_t block = (side + max_side - 1) / max_side;
  PreviewImage image{(resolution + block - 1u) / block, {}, std::max(1u, enlarged_side / side)};
  image.values.reserve(std::size_t{image.resolution.x} * image.resolution.y);
  for (std::uint32_t row = 0; row < resolution.y; row += block)
    for (std::uint32_t column = 0; column < resolution.x; column += block)
      image.values.push_back(scale == ColourScale::turn
                                 ? values[std::size_t{row} * resolution.x + column]
                                 : block_mean(values, resolution, {column, row}, block));
  return image;
}

Range preview_range(std::span<const float> values, ColourScale scale) {
  if (scale == ColourScale::turn)
    return {0.0, 2.0 * std::numbers::pi};
  if (scale == ColourScale::share)
    return {0.0, 1.0};
  const Range range = robust_range(values);
  if (scale == ColourScale::sequential)
    return widened(range);
  const double largest = std::max(std::abs(range.min), std::abs(range.max));
  return largest > 0.0 ? Range{-largest, largest} : Range{-1.0, 1.0};
}

Canvas draw_preview(std::span<const float> values, const glm::uvec2 &resolution, const Preview &preview,
                    const std::string &unit, const std::string &title) {
  const ColourMap &colours = colours_of(preview.scale);
  const PreviewImage image = preview_image(values, resolution, preview.scale);
  const Axis axis = make_axis(preview_range(image.values, preview.scale), 8);
  const std::string bar_title = axis_title(std::string(preview.quantity), unit, axis.exponent);
  const Axis rows = pixel_axis(resolution.y, image.resolution.y * image.enlargement);
  const Axis columns = pixel_axis(resolution.x, image.resolution.x * image.enlargement);
  const Layout layout =
      lay_out(image, axis, rows, text_width(title, title_size) * 1.15, text_width(bar_title));

  Canvas canvas(layout.width, layout.height);
  canvas.title(layout.image.left, 22.0, title);
  bool has_gaps = false;
  const SurfacePtr pixels = make_image(image.resolution, [&](std::uint32_t column, std::uint32_t row) {
    const float value = image.values[std::size_t{row} * image.resolution.x + column];
    has_gaps |= !std::isfinite(value);
    return std::isfinite(value) ? colours.at(along(axis.range, static_cast<double>(value), 1.0))
                                : no_value_colour;
  });
  canvas.image(pixels.get(), layout.image);
  canvas.outline(layout.image);
  canvas.bottom_axis(layout.image, columns);
  canvas.left_axis(layout.image, upside_down(rows));
  canvas.text(layout.image.left + 0.5 * layout.image.width, layout.image.bottom() + 36.0, "column",
              Anchor::centre);
  canvas.vertical_text(layout.image.left - label_width(rows) - 24.0,
                       layout.image.top + 0.5 * layout.image.height, "row");
  draw_colour_bar(canvas, layout.bar, axis, colours);
  canvas.text(layout.bar.left, layout.bar.top - 16.0, bar_title, Anchor::left);
  if (has_gaps)
    draw_no_value_legend(canvas, layout.bar.left, layout.bar.bottom() + 22.0);
  return canvas;
}

} // namespace pmdsim
