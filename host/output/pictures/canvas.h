#pragma once
// A drawing surface over Cairo: what previews and plots share. Coordinates are pixels, y down.

#include "host/output/files/output_file.h"
#include "host/output/pictures/axis.h"
#include "host/output/pictures/colour_map.h"

#include <cairo.h>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace pmdsim {

inline constexpr Colour black{0.1, 0.1, 0.1};
inline constexpr Colour white{1.0, 1.0, 1.0};
inline constexpr Colour light_grey{0.87, 0.87, 0.87};

inline constexpr double text_size = 13.0;
inline constexpr double title_size = 15.0;

struct Box {
  double left, top, width, height;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

inline bool overlap(const Box &a, const Box &b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

// Where a label's text stands relative to its point.
enum class Anchor { left, centre, right };

using SurfacePtr = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
// Throws std::bad_alloc where there is no memory.
SurfacePtr make_surface(int width, int height);

// Whoever draws while other threads may holds this from before the first text is measured until the canvas is
// gone: Cairo (1.16) keeps its fonts for all threads and does not guard them.
std::mutex &drawing_mutex();

class Canvas {
public:
  // A white canvas. Throws std::bad_alloc where there is no memory.
  Canvas(int width, int height);

  int width() const;
  int height() const;

  void fill(const Box &box, const Colour &colour);
  void outline(const Box &box);
  void line(std::pair<double, double> from, std::pair<double, double> to, const Colour &colour,
            double width = 1.0);
  // `y` is the middle of the text's capitals.
  void text(double x, double y, const std::string &text, Anchor anchor);
  void title(double x, double y, const std::string &text);
  // Reads from bottom to top; (x, y) is its middle.
  void vertical_text(double x, double y, const std::string &text);
  // Scales `image` to the box without smoothing.
  void image(cairo_surface_t *image, const Box &box);

  // Ticks and labels below a box's lower edge and left or right of its side.
  void bottom_axis(const Box &box, const Axis &axis);
  void left_axis(const Box &box, const Axis &axis);
  void right_axis(const Box &box, const Axis &axis);
  // grid() lies below a plot's curves: lines at the ticks, that at 0 of the left axis of a colour of its own.
  // frame() lies around them: the outline, the axes and their titles.
  void grid(const Box &box, const Axis &bottom, const Axis &left, const Colour &at_zero = light_grey);
  void frame(const Box &box, const Axis &bottom, const Axis &left, const std::string &bottom_title,
             const std::string &left_title);

  // For what the verbs above do not cover.
  cairo_t *context() { return context_.get(); }

  // Throws Error (output).
  void write_png(OutputFile &file) const;
  // The file's bytes.
  std::string png() const;

private:
  SurfacePtr surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

// Width of a text in pixels, for layouts that need it before there is a canvas.
double text_width(const std::string &text, double size = text_size);
// The widest label of an axis.
double label_width(const Axis &axis);
// The box of a plot `top` below the upper edge of a canvas of this size, with room for its axes and their
// titles.
Box plot_box(int width, int height, double top, const Axis &left);

// Position of a value along a length, 0 at the axis's minimum.
double along(const Range &range, double value, double length);

} // namespace pmdsim
