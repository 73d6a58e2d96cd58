#include "host/output/clouds/cloud_picture.h"

#include "host/output/pictures/image.h"
#include "host/output/pictures/key.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>

namespace pmdsim {
namespace {

constexpr int picture_width = 820, picture_height = 660;
constexpr Box whole{16.0, 48.0, picture_width - 32.0, picture_height - 96.0};
constexpr int cloud_columns = picture_width - 32, cloud_rows = picture_height - 96;
constexpr Colour background{0.96, 0.96, 0.96};

std::pair<double, double> on_canvas(const glm::dvec3 &place) {
  return {whole.left + place.x, whole.top + place.y};
}

void draw_camera(Canvas &canvas, const CloudView &view) {
  const std::vector<glm::dvec3> &camera_m = view.camera_m();
  const auto lens = on_canvas(view.place(camera_m.front()));
  for (std::size_t i = 1; i < camera_m.size(); ++i) {
    const auto corner = on_canvas(view.place(camera_m[i]));
    canvas.line(lens, corner, black, 1.5);
    canvas.line(corner, on_canvas(view.place(camera_m[i % (camera_m.size() - 1) + 1])), black, 1.5);
  }
  canvas.text(lens.first, lens.second + 14.0, "camera", Anchor::centre);
}

// About a fifth of the picture's width, on the left, as the camera is on the right.
void draw_scale(Canvas &canvas, const CloudView &view) {
  const double fifth_m = 0.2 * whole.width / view.pixels_a_metre();
  const double power = std::pow(10.0, std::floor(std::log10(fifth_m)));
  const double length_m = power * (fifth_m >= 5.0 * power ? 5.0 : fifth_m >= 2.0 * power ? 2.0 : 1.0);
  const double left = whole.left + 12.0, y = whole.bottom() - 14.0;
  canvas.line({left, y}, {left + length_m * view.pixels_a_metre(), y}, black, 3.0);
  canvas.text(left, y - 14.0, value_text(length_m) + " m in the middle", Anchor::left);
}

std::string caption_of(const PointCloud &cloud) {
  std::string text =
      fmt::format("{} {}, seen from the side", cloud.distance().name(), cloud.way_of_distances());
  if (cloud.brightest())
    text += fmt::format("; colour: square root of amplitude, yellow from {} W/(m² sr)",
                        value_text(*cloud.brightest()));
  return text;
}

} // namespace

CloudPicture::CloudPicture(const PointCloud &cloud)
    : cloud_(cloud), view_(cloud, {cloud_columns, cloud_rows}),
      colours_(std::size_t{cloud_columns} * cloud_rows, background) {
  if (view_.has_points())
    fill();
}

// With squares, of which the nearest wins.
void CloudPicture::fill() {
  std::vector<double> depths_m(colours_.size(), std::numeric_limits<double>::infinity());
  const int side = view_.point_side();
  cloud_.for_each([&](std::size_t pixel, const glm::dvec3 &point_m) {
    const glm::dvec3 place = view_.place(point_m);
    const glm::dvec2 corner = glm::floor(glm::dvec2(place)) - std::floor(0.5 * side);
    if (!(place.z > 0.0 && corner.x > -side && corner.y > -side && corner.x < cloud_columns &&
          corner.y < cloud_rows))
      return;
    const glm::ivec2 first(corner);
    const Colour colour = cloud_.colour(pixel);
    for (int y = std::max(first.y, 0); y < std::min(first.y + side, cloud_rows); ++y)
      for (int x = std::max(first.x, 0); x < std::min(first.x + side, cloud_columns); ++x)
        if (const std::size_t at = static_cast<std::size_t>(y) * cloud_columns + static_cast<std::size_t>(x);
            place.z < depths_m[at]) {
          depths_m[at] = place.z;
          colours_[at] = colour;
        }
  });
}

Canvas CloudPicture::draw(const std::string &title) const {
  Canvas canvas(picture_width, picture_height);
  canvas.title(whole.left, 22.0, title);
  const SurfacePtr pixels =
      make_image({cloud_columns, cloud_rows}, [&](std::uint32_t column, std::uint32_t row) {
        return colours_[std::size_t{row} * cloud_columns + column];
      });
  canvas.image(pixels.get(), whole);
  canvas.outline(whole);
  if (!view_.has_points()) {
    canvas.text(whole.left + 0.5 * whole.width, whole.top + 0.5 * whole.height, "no point", Anchor::centre);
    return canvas;
  }
  if (!view_.camera_m().empty())
    draw_camera(canvas, view_);
  draw_scale(canvas, view_);
  canvas.text(whole.left, whole.bottom() + 22.0, caption_of(cloud_), Anchor::left);
  return canvas;
}

} // namespace pmdsim
