#include "host/output/pictures/canvas.h"

#include "host/output/files/output_file.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fmt/format.h>
#include <functional>
#include <new>
#include <string_view>

namespace pmdsim {
namespace {

constexpr double tick_length = 4.0;
constexpr double label_gap = 4.0;

void use_font(cairo_t *context, double size, cairo_font_weight_t weight = CAIRO_FONT_WEIGHT_NORMAL) {
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, weight);
  cairo_set_font_size(context, size);
}

void use_colour(cairo_t *context, const Colour &colour) {
  cairo_set_source_rgb(context, colour[0], colour[1], colour[2]);
}

// Lines of one pixel are sharp only on half coordinates.
double crisp(double coordinate) { return std::floor(coordinate) + 0.5; }

// Throws std::bad_alloc where there is no memory: a text without a size would move all others.
cairo_text_extents_t extents_of(cairo_t *context, const char *text) {
  cairo_text_extents_t extents;
  cairo_text_extents(context, text, &extents);
  if (cairo_status(context) == CAIRO_STATUS_NO_MEMORY)
    throw std::bad_alloc();
  return extents;
}

double advance(cairo_t *context, const std::string &text) {
  return extents_of(context, text.c_str()).x_advance;
}

double capital_height(cairo_t *context) { return extents_of(context, "H").height; }

struct PngSink {
  std::function<void(std::string_view)> write;
  std::exception_ptr failure;
};

// Called from C: an exception waits in the sink until Cairo has returned.
cairo_status_t append(void *closure, const unsigned char *bytes, unsigned count) {
  auto &sink = *static_cast<PngSink *>(closure);
  try {
    sink.write({reinterpret_cast<const char *>(bytes), count});
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {
    sink.failure = std::current_exception();
    return CAIRO_STATUS_WRITE_ERROR;
  }
}

// A context that has failed draws nothing more, and its surface knows nothing of that.
cairo_status_t write_drawn(cairo_t *context, cairo_surface_t *surface,
                           std::function<void(std::string_view)> write) {
  if (const cairo_status_t drawn = cairo_status(context); drawn != CAIRO_STATUS_SUCCESS)
    return drawn;
  PngSink sink{std::move(write), {}};
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface, &append, &sink);
  if (sink.failure)
    std::rethrow_exception(sink.failure);
  return status;
}

// libpng's errors have no code of their own; of a picture that is drawn they can be no others.
bool lacks_memory(cairo_status_t status) {
  return status == CAIRO_STATUS_NO_MEMORY || status == CAIRO_STATUS_PNG_ERROR;
}

} // namespace

SurfacePtr make_surface(int width, int height) {
  SurfacePtr surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), &cairo_surface_destroy);
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS)
    throw std::bad_alloc();
  return surface;
}

std::mutex &drawing_mutex() {
  static std::mutex mutex;
  return mutex;
}

Canvas::Canvas(int width, int height)
    : surface_(make_surface(width, height)), context_(cairo_create(surface_.get()), &cairo_destroy) {
  if (cairo_status(context_.get()) != CAIRO_STATUS_SUCCESS)
    throw std::bad_alloc();
  use_colour(context(), white);
  cairo_paint(context());
}

int Canvas::width() const { return cairo_image_surface_get_width(surface_.get()); }
int Canvas::height() const { return cairo_image_surface_get_height(surface_.get()); }

void Canvas::fill(const Box &box, const Colour &colour) {
  use_colour(context(), colour);
  cairo_rectangle(context(), box.left, box.top, box.width, box.height);
  cairo_fill(context());
}

void Canvas::outline(const Box &box) {
  use_colour(context(), black);
  cairo_set_line_width(context(), 1.0);
  cairo_rectangle(context(), box.left - 0.5, box.top - 0.5, box.width + 1.0, box.height + 1.0);
  cairo_stroke(context());
}

void Canvas::line(std::pair<double, double> from, std::pair<double, double> to, const Colour &colour,
                  double width) {
  use_colour(context(), colour);
  cairo_set_line_width(context(), width);
  cairo_move_to(context(), crisp(from.first), crisp(from.second));
  cairo_line_to(context(), crisp(to.first), crisp(to.second));
  cairo_stroke(context());
}

void Canvas::text(double x, double y, const std::string &text, Anchor anchor) {
  use_font(context(), text_size);
  use_colour(context(), black);
  const double shift = anchor == Anchor::left ? 0.0 : anchor == Anchor::centre ? 0.5 : 1.0;
  cairo_move_to(context(), x - shift * advance(context(), text), y + 0.5 * capital_height(context()));
  cairo_show_text(context(), text.c_str());
}

void Canvas::title(double x, double y, const std::string &text) {
  use_font(context(), title_size, CAIRO_FONT_WEIGHT_BOLD);
  use_colour(context(), black);
  cairo_move_to(context(), x, y + 0.5 * capital_height(context()));
  cairo_show_text(context(), text.c_str());
}

void Canvas::vertical_text(double x, double y, const std::string &text) {
  cairo_save(context());
  cairo_translate(context(), x, y);
  cairo_rotate(context(), -1.5707963267948966);
  this->text(0.0, 0.0, text, Anchor::centre);
  cairo_restore(context());
}

void Canvas::image(cairo_surface_t *image, const Box &box) {
  cairo_save(context());
  cairo_translate(context(), box.left, box.top);
  cairo_scale(context(), box.width / cairo_image_surface_get_width(image),
              box.height / cairo_image_surface_get_height(image));
  cairo_set_source_surface(context(), image, 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(context()), CAIRO_FILTER_NEAREST);
  cairo_pattern_set_extend(cairo_get_source(context()), CAIRO_EXTEND_PAD);
  cairo_rectangle(context(), 0.0, 0.0, cairo_image_surface_get_width(image),
                  cairo_image_surface_get_height(image));
  cairo_fill(context());
  cairo_restore(context());
}

void Canvas::bottom_axis(const Box &box, const Axis &axis) {
  for (const Tick &tick : axis.ticks) {
    const double x = box.left + along(axis.range, tick.value, box.width);
    line({x, box.bottom()}, {x, box.bottom() + tick_length}, black);
    text(x, box.bottom() + tick_length + label_gap + 0.4 * text_size, tick.label, Anchor::centre);
  }
}

void Canvas::left_axis(const Box &box, const Axis &axis) {
  for (const Tick &tick : axis.ticks) {
    const double y = box.bottom() - along(axis.range, tick.value, box.height);
    line({box.left - 1.0 - tick_length, y}, {box.left - 1.0, y}, black);
    text(box.left - tick_length - label_gap, y, tick.label, Anchor::right);
  }
}

void Canvas::right_axis(const Box &box, const Axis &axis) {
  for (const Tick &tick : axis.ticks) {
    const double y = box.bottom() - along(axis.range, tick.value, box.height);
    line({box.right(), y}, {box.right() + tick_length, y}, black);
    text(box.right() + tick_length + label_gap, y, tick.label, Anchor::left);
  }
}

void Canvas::grid(const Box &box, const Axis &bottom, const Axis &left, const Colour &at_zero) {
  for (const Tick &tick : bottom.ticks) {
    const double x = box.left + along(bottom.range, tick.value, box.width);
    line({x, box.top}, {x, box.bottom()}, light_grey);
  }
  for (const Tick &tick : left.ticks) {
    const double y = box.bottom() - along(left.range, tick.value, box.height);
    line({box.left, y}, {box.right(), y}, tick.value == 0.0 ? at_zero : light_grey);
  }
}

void Canvas::frame(const Box &box, const Axis &bottom, const Axis &left, const std::string &bottom_title,
                   const std::string &left_title) {
  outline(box);
  bottom_axis(box, bottom);
  left_axis(box, left);
  text(box.left + 0.5 * box.width, height() - 22.0, bottom_title, Anchor::centre);
  vertical_text(22.0, box.top + 0.5 * box.height, left_title);
}

void Canvas::write_png(OutputFile &file) const {
  const cairo_status_t status =
      write_drawn(context_.get(), surface_.get(), [&](std::string_view bytes) { file.write(bytes); });
  if (status != CAIRO_STATUS_SUCCESS)
    throw write_error(file.path(), cairo_status_to_string(status),
                      lacks_memory(status) ? Lacking::memory : Lacking::other);
}

std::string Canvas::png() const {
  std::string png;
  if (write_drawn(context_.get(), surface_.get(), [&](std::string_view bytes) { png += bytes; }) !=
      CAIRO_STATUS_SUCCESS)
    throw std::bad_alloc(); // there is nothing else that could fail
  return png;
}

double text_width(const std::string &text, double size) {
  static Canvas scratch(1, 1);
  use_font(scratch.context(), size);
  return advance(scratch.context(), text);
}

double label_width(const Axis &axis) {
  double widest = 0.0;
  for (const Tick &tick : axis.ticks)
    widest = std::max(widest, text_width(tick.label));
  return widest;
}

Box plot_box(int width, int height, double top, const Axis &left) {
  const double room = std::round(52.0 + label_width(left));
  return {room, top, width - room - 24.0, height - top - 64.0};
}

double along(const Range &range, double value, double length) {
  return (value - range.min) / range.span() * length;
}

} // namespace pmdsim
