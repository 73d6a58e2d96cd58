#include "host/output/pictures/plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace pmdsim {
namespace {

constexpr int noise_width = 900, noise_height = 560;
constexpr double dot_radius = 3.5;
const std::array<Colour, 3> noise_colours{{{0.12, 0.38, 0.68}, {0.20, 0.55, 0.27}, {0.80, 0.33, 0.10}}};

// Predicted and found values over x, all above 0 where they are there.
struct Curve {
  std::string name;
  Colour colour;
  struct Point {
    double x;
    std::optional<double> predicted, found;
  };
  std::vector<Point> points;
};

void include(Range &range, double value) { range = {std::min(range.min, value), std::max(range.max, value)}; }

Axis log_axis_of(Range range) {
  if (!(range.max > 0.0))
    range = {0.1, 10.0};
  return make_log_axis({range.min / 1.3, range.max * 1.3});
}

class LogPlot {
public:
  explicit LogPlot(const std::vector<Curve> &curves) {
    Range x{std::numeric_limits<double>::infinity(), 0.0}, y = x;
    for (const Curve &curve : curves)
      for (const Curve::Point &point : curve.points) {
        include(x, point.x);
        for (const auto &value : {point.predicted, point.found})
          if (value)
            include(y, *value);
      }
    x_ = log_axis_of(x);
    y_ = log_axis_of(y);
    box_ = plot_box(noise_width, noise_height, 76.0, y_);
  }

  void draw(Canvas &canvas, const std::vector<Curve> &curves, const std::string &title,
            const std::string &x_title, const std::string &y_title) const {
    canvas.title(box_.left, 24.0, title);
    canvas.grid(box_, x_, y_);
    for (const Curve &curve : curves) {
      draw_line(canvas, curve);
      draw_dots(canvas, curve);
    }
    canvas.frame(box_, x_, y_, x_title, y_title);
    draw_names(canvas, curves);
  }

private:
  std::pair<double, double> place(double x, double y) const {
    return {box_.left + along(x_.range, std::log10(x), box_.width),
            box_.bottom() - along(y_.range, std::log10(y), box_.height)};
  }

  void draw_line(Canvas &canvas, const Curve &curve) const {
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
      const Curve::Point &a = curve.points[i - 1], &b = curve.points[i];
      if (a.predicted && b.predicted)
        canvas.line(place(a.x, *a.predicted), place(b.x, *b.predicted), curve.colour, 2.0);
    }
  }

  void draw_dots(Canvas &canvas, const Curve &curve) const {
    cairo_t *context = canvas.context();
    for (const Curve::Point &point : curve.points) {
      if (!point.found)
        continue;
      const auto [x, y] = place(point.x, *point.found);
      cairo_new_path(context);
      cairo_arc(context, x, y, dot_radius, 0.0, 6.283185307179586);
      cairo_set_source_rgb(context, curve.colour[0], curve.colour[1], curve.colour[2]);
      cairo_fill(context);
    }
  }

  void draw_names(Canvas &canvas, const std::vector<Curve> &curves) const {
    double x = box_.left;
    const double y = box_.top - 18.0;
    for (const Curve &curve : curves) {
      canvas.line({x, y}, {x + 18.0, y}, curve.colour, 3.0);
      canvas.text(x + 24.0, y, curve.name, Anchor::left);
      x += 48.0 + text_width(curve.name);
    }
    canvas.text(x, y, "lines predicted, dots found in frames", Anchor::left);
  }

  Axis x_, y_;
  Box box_{};
};

Canvas drawn(const std::vector<Curve> &curves, const std::string &title, const std::string &x_title,
             const std::string &y_title) {
  const LogPlot plot(curves);
  Canvas canvas(noise_width, noise_height);
  plot.draw(canvas, curves, title, x_title, y_title);
  return canvas;
}

std::optional<double> above_zero(double value) { return value > 0.0 ? std::optional(value) : std::nullopt; }

} // namespace

Canvas draw_precision(const NoiseStudy &study) {
  std::vector<Curve> curves;
  for (const PrecisionPoint &point : study.precision) {
    const std::string name = fmt::format("reflectivity {:.3g}", point.reflectivity);
    if (curves.empty() || curves.back().name != name)
      curves.push_back({name, noise_colours[curves.size() % noise_colours.size()], {}});
    const auto in_mm = [](const std::optional<double> &value_m) {
      return value_m ? above_zero(1e3 * *value_m) : std::nullopt;
    };
    curves.back().points.push_back({point.distance_m, in_mm(point.predicted_m), in_mm(point.found_m)});
  }
  return drawn(
      curves, fmt::format("precision of distances, {}, {:.6g} MHz", study.sensor, 1e-6 * study.modulation_hz),
      "distance of a wall across the optical axis (m)", "standard deviation of distance (mm)");
}

Canvas draw_transfer(const NoiseStudy &study) {
  Curve curve{"temporal variance of tap A", noise_colours[0], {}};
  for (const TransferPoint &point : study.transfer)
    if (point.mean_dn > 0.0)
      curve.points.push_back(
          {point.mean_dn, above_zero(point.variance_dn2), above_zero(point.found_variance_dn2)});
  return drawn({curve}, fmt::format("photon transfer, {}", study.sensor), "mean (DN)", "variance (DN²)");
}

} // namespace pmdsim
