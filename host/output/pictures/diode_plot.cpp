#include "host/output/pictures/plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>
#include <vector>

namespace pmdsim {
namespace {

constexpr double plot_side = 560.0, plot_top = 84.0;
constexpr double least_radius = 2.5, largest_radius = 11.0;
constexpr std::size_t named_diodes = 10;

// A square of the camera's x and y about all diodes and the lens.
struct BoardArea {
  Range x, y;
};

BoardArea area_of(const std::vector<StudiedDiode> &diodes) {
  constexpr double margin = 0.58, least_mm = 1.0;
  Range x{0.0, 0.0}, y = x;
  for (const StudiedDiode &diode : diodes) {
    const glm::dvec2 mm = 1e3 * glm::dvec2(diode.in_camera_m);
    x = {std::min(x.min, mm.x), std::max(x.max, mm.x)};
    y = {std::min(y.min, mm.y), std::max(y.max, mm.y)};
  }
  const double half = margin * std::max({x.span(), y.span(), least_mm});
  const double middle_x = 0.5 * (x.min + x.max), middle_y = 0.5 * (y.min + y.max);
  return {{middle_x - half, middle_x + half}, {middle_y - half, middle_y + half}};
}

void disc(Canvas &canvas, double x, double y, double radius, const Colour &colour) {
  cairo_t *context = canvas.context();
  cairo_new_path(context);
  cairo_arc(context, x, y, radius, 0.0, 2.0 * std::numbers::pi);
  cairo_set_source_rgb(context, colour[0], colour[1], colour[2]);
  cairo_fill_preserve(context);
  cairo_set_source_rgb(context, black[0], black[1], black[2]);
  cairo_set_line_width(context, 0.7);
  cairo_stroke(context);
}

void colour_bar(Canvas &canvas, const Box &box, const Axis &axis, const std::string &title) {
  for (double y = 0.0; y < box.height; y += 1.0)
    canvas.fill({box.left, box.top + y, box.width, 1.0}, viridis.at(1.0 - (y + 0.5) / box.height));
  canvas.outline(box);
  canvas.right_axis(box, axis);
  canvas.text(box.left, box.top - 16.0, title, Anchor::left);
}

class DiodePlot {
public:
  explicit DiodePlot(const DiodeStudy &study)
      : study_(study), area_(area_of(study.diodes)), columns_(make_axis(area_.x, 8)),
        rows_(make_axis(area_.y, 8)), ranking_(study.ranking()) {
    std::swap(rows_.range.min, rows_.range.max); // y down, as in the image
    const double most_um = part_um(ranking_.front());
    values_ = make_axis({0.0, most_um > 0.0 ? most_um : 1.0}, 8);
    const double left = std::round(52.0 + label_width(rows_));
    box_ = {left, plot_top, plot_side, plot_side};
    radius_ = std::clamp(0.5 * nearest_neighbours(), least_radius, largest_radius);
  }

  Canvas draw() const {
    const std::string bar_title =
        axis_title("part in standard deviation, less the offset", "µm", values_.exponent);
    const Box bar{box_.right() + 28.0, plot_top, 18.0, plot_side};
    Canvas canvas(static_cast<int>(bar.left + std::max(100.0, text_width(bar_title)) + 20.0),
                  static_cast<int>(box_.bottom() + 64.0));
    canvas.title(
        box_.left, 22.0,
        fmt::format("diodes that matter, {}, {:.6g} MHz", study_.sensor, 1e-6 * study_.modulation_hz));
    canvas.text(
        box_.left, 48.0,
        "colour and area: a diode's part in what boards differ by at their offset; numbers: the largest",
        Anchor::left);
    canvas.grid(box_, columns_, rows_);
    draw_lens(canvas);
    for (auto m = ranking_.rbegin(); m != ranking_.rend(); ++m) // the largest last, on top
      draw_diode(canvas, *m);
    std::vector<Box> taken;
    for (const StudiedDiode &diode : study_.diodes) {
      const auto [x, y] = place(diode.in_camera_m);
      taken.push_back({x - radius_, y - radius_, 2.0 * radius_, 2.0 * radius_});
    }
    for (std::size_t i = 0; i < std::min(named_diodes, ranking_.size()); ++i)
      draw_name(canvas, ranking_[i], taken);
    canvas.frame(box_, columns_, rows_, "x in the sensor's frame (mm)", "y in the sensor's frame (mm)");
    colour_bar(canvas, bar, values_, bar_title);
    return canvas;
  }

private:
  double part_um(std::size_t m) const { return um_per_m * study_.part_m(m); }

  std::pair<double, double> place(const glm::dvec3 &in_camera_m) const {
    return {box_.left + along(columns_.range, 1e3 * in_camera_m.x, box_.width),
            box_.bottom() - along(rows_.range, 1e3 * in_camera_m.y, box_.height)};
  }

  // The distance of the two diodes that are the nearest to each other, but for those at one place.
  double nearest_neighbours() const {
    double nearest = plot_side;
    for (std::size_t a = 0; a < study_.diodes.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const auto [ax, ay] = place(study_.diodes[a].in_camera_m);
        const auto [bx, by] = place(study_.diodes[b].in_camera_m);
        const double distance = std::hypot(ax - bx, ay - by);
        nearest = distance > 0.5 ? std::min(nearest, distance) : nearest;
      }
    return nearest;
  }

  void draw_lens(Canvas &canvas) const {
    constexpr double arm = 7.0;
    const auto [x, y] = place(glm::dvec3(0.0));
    canvas.line({x - arm, y}, {x + arm, y}, black);
    canvas.line({x, y - arm}, {x, y + arm}, black);
    canvas.text(x + arm + 3.0, y + 10.0, "lens", Anchor::left);
  }

  void draw_diode(Canvas &canvas, std::size_t m) const {
    const auto [x, y] = place(study_.diodes[m].in_camera_m);
    const double share = part_um(m) / values_.range.max;
    disc(canvas, x, y, std::max(least_radius, radius_ * std::sqrt(share)), viridis.at(share));
  }

  // Beside the diode, away from the middle if there is room; left out where a larger one's name is in the
  // way.
  void draw_name(Canvas &canvas, std::size_t m, std::vector<Box> &taken) const {
    const auto [x, y] = place(study_.diodes[m].in_camera_m);
    const std::string name = study_.illuminators.size() > 1 ? diode_name(study_.diodes[m])
                                                            : std::to_string(study_.diodes[m].number);
    const double width = text_width(name), beside = radius_ + 4.0;
    std::array lefts{x + beside, x - beside - width};
    if (x < box_.left + 0.5 * box_.width)
      std::swap(lefts[0], lefts[1]);
    for (const double left : lefts) {
      const Box box{left - 1.0, y - 0.55 * text_size, width + 2.0, 1.1 * text_size};
      const bool is_inside = box.left > box_.left && box.right() < box_.right();
      if (!is_inside || std::ranges::any_of(taken, [&](const Box &other) { return overlap(box, other); }))
        continue;
      canvas.fill(box, white);
      canvas.text(left, y, name, Anchor::left);
      taken.push_back(box);
      return;
    }
  }

  const DiodeStudy &study_;
  BoardArea area_;
  Axis columns_, rows_, values_;
  std::vector<std::size_t> ranking_;
  Box box_{};
  double radius_ = largest_radius; // of the one that matters most
};

} // namespace

Canvas draw_diodes(const DiodeStudy &study) { return DiodePlot(study).draw(); }

} // namespace pmdsim
