#include "host/output/pictures/plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

namespace pmdsim {
namespace {

constexpr int tradeoff_width = 1000, tradeoff_height = 640;
constexpr double marker_radius = 5.0;

struct Series {
  std::string name;
  Colour colour;
};
const std::array<Series, 4> all_series{{{"exact", {0.15, 0.15, 0.15}},
                                        {"reduced", {0.12, 0.38, 0.68}},
                                        {"auto", {0.80, 0.33, 0.10}},
                                        {"samples", {0.20, 0.55, 0.27}}}};

struct Marker {
  const TradeoffPoint *point;
  double x, y;
};

struct Plot {
  Box box;
  Axis time_ms, error_um;
};

const Colour &colour_of(const TradeoffPoint &point) {
  return std::ranges::find(all_series, series_name(point), &Series::name)->colour;
}

// An error of 0 has no place on a logarithmic axis: it stands below what a float32 of a distance can show.
double shown_um(const TradeoffPoint &point) { return std::max(1e6 * *point.smooth.max_m, 1e-6); }

std::vector<const TradeoffPoint *> shown_points(const Tradeoff &tradeoff) {
  std::vector<const TradeoffPoint *> shown;
  for (const TradeoffPoint &point : tradeoff.points)
    if (point.refusal.empty() && point.smooth.max_m && point.time.median_ms > 0.0)
      shown.push_back(&point);
  return shown;
}

// Twice as far as the values reach on either side.
template <class Value>
Range range_of(const std::vector<const TradeoffPoint *> &points, const Value &value) {
  Range range{std::numeric_limits<double>::infinity(), 0.0};
  for (const TradeoffPoint *point : points)
    range = {std::min(range.min, value(*point)), std::max(range.max, value(*point))};
  return range.max > 0.0 ? Range{0.5 * range.min, 2.0 * range.max} : Range{0.1, 10.0};
}

std::vector<Marker> markers_of(const Plot &plot, const std::vector<const TradeoffPoint *> &points) {
  std::vector<Marker> markers;
  for (const TradeoffPoint *point : points) {
    const double time = std::log10(point->time.median_ms), error = std::log10(shown_um(*point));
    markers.push_back({point, plot.box.left + along(plot.time_ms.range, time, plot.box.width),
                       plot.box.bottom() - along(plot.error_um.range, error, plot.box.height)});
  }
  return markers;
}

void draw_front(Canvas &canvas, const std::vector<Marker> &markers, Sweep sweep, const Colour &colour) {
  std::vector<Marker> front;
  std::ranges::copy_if(markers, std::back_inserter(front), [&](const Marker &marker) {
    return marker.point->pareto && marker.point->sweep == sweep;
  });
  std::ranges::sort(front, {}, &Marker::x);
  for (std::size_t i = 1; i < front.size(); ++i)
    canvas.line({front[i - 1].x, front[i - 1].y}, {front[i].x, front[i].y}, colour, 2.0);
}

// Filled on the front, a ring elsewhere.
void draw_marker(Canvas &canvas, double x, double y, const Colour &colour, bool filled) {
  cairo_t *context = canvas.context();
  cairo_new_path(context); // a text leaves its end as a point to go on from
  cairo_arc(context, x, y, marker_radius, 0.0, 6.283185307179586);
  const Colour &inside = filled ? colour : white;
  cairo_set_source_rgb(context, inside[0], inside[1], inside[2]);
  cairo_fill_preserve(context);
  cairo_set_source_rgb(context, colour[0], colour[1], colour[2]);
  cairo_set_line_width(context, 2.0);
  cairo_stroke(context);
}

// Where a label may stand beside its marker, best first: fronts fall to the right.
constexpr std::array<std::pair<double, double>, 8> directions{
    {{1.0, -1.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, -1.0}, {-1.0, 1.0}, {0.0, 1.0}, {-1.0, 0.0}, {-1.0, -1.0}}};

// Beside its marker where that is free, else farther and farther off; nothing where it is crowded all around.
std::optional<Box> free_place(const Marker &marker, double width, const std::vector<Box> &taken,
                              const Box &whole) {
  const double height = text_size;
  constexpr int distances = 13; // from the marker, 4 apart
  for (int i = 0; i < distances; ++i)
    for (const auto &[right, down] : directions) {
      const double away = marker_radius + 3.0 + 4.0 * i;
      const double x = marker.x + right * (away + 0.5 * width), y = marker.y + down * (away + 0.5 * height);
      const Box place{x - 0.5 * width, y - 0.5 * height, width, height};
      const bool inside = place.left > whole.left && place.right() < whole.right() && place.top > whole.top &&
                          place.bottom() < whole.bottom();
      if (inside && std::ranges::none_of(taken, [&](const Box &other) { return overlap(place, other); }))
        return place;
    }
  return std::nullopt;
}

void draw_labels(Canvas &canvas, const std::vector<Marker> &markers, const Box &whole) {
  std::vector<Box> taken;
  taken.reserve(2 * markers.size());
  for (const Marker &marker : markers)
    taken.push_back({marker.x - marker_radius - 1.0, marker.y - marker_radius - 1.0,
                     2.0 * marker_radius + 2.0, 2.0 * marker_radius + 2.0});
  for (const Marker &marker : markers) {
    const std::string label = point_label(*marker.point);
    if (const auto place = free_place(marker, text_width(label) + 2.0, taken, whole)) {
      taken.push_back(*place);
      const double x = std::clamp(marker.x, place->left, place->right());
      const double y = std::clamp(marker.y, place->top, place->bottom());
      if (std::hypot(x - marker.x, y - marker.y) > 3.0 * marker_radius)
        canvas.line({marker.x, marker.y}, {x, y}, colour_of(*marker.point), 1.0);
      canvas.text(place->left + 0.5 * place->width, place->top + 0.5 * place->height, label, Anchor::centre);
    }
  }
}

// Above the plot, one name after the other.
void draw_legend(Canvas &canvas, const Plot &plot, const std::vector<Marker> &markers) {
  double x = plot.box.left + marker_radius;
  const double y = plot.box.top - 18.0;
  const auto say = [&](const std::string &text) {
    canvas.text(x + 10.0, y, text, Anchor::left);
    x += text_width(text) + 36.0;
  };
  for (const auto &series : all_series) {
    const auto known = std::ranges::find_if(
        markers, [&](const Marker &marker) { return series_name(*marker.point) == series.name; });
    if (known == markers.end())
      continue;
    draw_marker(canvas, x, y, series.colour, true);
    say(fmt::format("{}, against S = {}", series.name, known->point->reference_samples));
  }
  say("filled, joined: Pareto fronts");
}

} // namespace

Canvas draw_tradeoff(const Tradeoff &tradeoff) {
  const auto points = shown_points(tradeoff);
  const Axis time_ms =
      make_log_axis(range_of(points, [](const auto &point) { return point.time.median_ms; }));
  const Axis error_um = make_log_axis(range_of(points, shown_um));
  const Plot plot{plot_box(tradeoff_width, tradeoff_height, 76.0, error_um), time_ms, error_um};

  Canvas canvas(tradeoff_width, tradeoff_height);
  canvas.title(plot.box.left, 24.0,
               fmt::format("speed against accuracy, {}, {}",
                           std::filesystem::path(tradeoff.setup).filename().string(), tradeoff.sensor));
  canvas.grid(plot.box, time_ms, error_um);
  canvas.frame(plot.box, time_ms, error_um, fmt::format("median time of a frame on {} (ms)", tradeoff.device),
               "largest distance error beside edges (µm)");
  const std::vector<Marker> markers = markers_of(plot, points);
  draw_front(canvas, markers, Sweep::modes, all_series[0].colour);
  draw_front(canvas, markers, Sweep::samples, all_series[3].colour);
  for (const Marker &marker : markers)
    draw_marker(canvas, marker.x, marker.y, colour_of(*marker.point), marker.point->pareto);
  draw_labels(canvas, markers, plot.box);
  draw_legend(canvas, plot, markers);
  if (markers.empty())
    canvas.text(plot.box.left + 0.5 * plot.box.width, plot.box.top + 0.5 * plot.box.height,
                "nothing could be compared beside edges", Anchor::centre);
  return canvas;
}

} // namespace pmdsim
