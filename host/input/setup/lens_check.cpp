#include "host/input/setup/lens_check.h"

#include "engine/lens/lens.h"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

namespace pmdsim {
namespace {

// The image's corners and, between them, the middles of its sides.
std::vector<glm::dvec2> rim(const Sensor &sensor) {
  std::vector<glm::dvec2> places;
  const glm::dvec2 end(sensor.resolution);
  for (const double row : {0.0, 0.5, 1.0})
    for (const double column : {0.0, 0.5, 1.0})
      if (row != 0.5 || column != 0.5)
        places.push_back(glm::dvec2(column, row) * end);
  return places;
}

// How far one gets from the optical axis towards a place without a ray, pixels.
double pixels_to_fold(const Lens &lens, const glm::dvec2 &axis_pixel, const glm::dvec2 &pixel) {
  constexpr int halvings = 50;
  double reached = 0.0, missed = 1.0; // of the way
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (reached + missed);
    (lens.ray(lens.on_chip_m(glm::mix(axis_pixel, pixel, middle))) ? reached : missed) = middle;
  }
  return reached * glm::length(pixel - axis_pixel);
}

std::string fold_expectation(const Sensor &sensor, const Lens &lens) {
  std::string text = "expected a distortion that does not fold over inside the image";
  const std::optional<glm::dvec2> axis_m = lens.chip_m({0.0, 0.0, 1.0});
  const std::vector<glm::dvec2> places = rim(sensor);
  const auto place =
      std::ranges::find_if(places, [&](const glm::dvec2 &pixel) { return !lens.ray(lens.on_chip_m(pixel)); });
  if (!axis_m || place == places.end())
    return text;
  return fmt::format("{}; it does {:.4g} pixels from the optical axis towards column {}, row {}", text,
                     pixels_to_fold(lens, lens.pixel(*axis_m), *place), place->x, place->y);
}

std::string limit_expectation(const Sensor &sensor) {
  return std::holds_alternative<Fisheye>(sensor.distortion)
             ? "expected an image within 179 degrees of the optical axis (fisheye)"
             : "expected an image within 89 degrees of the optical axis (brown)";
}

LensProblem problem_of(LensFault fault, const Sensor &sensor, const Lens &lens) {
  switch (fault) {
  case LensFault::chip_behind_lens:
    return {"chip", "expected the whole chip in front of the lens"};
  case LensFault::distortion_folds:
    return {"distortion", fold_expectation(sensor, lens)};
  case LensFault::beyond_model:
    return {"distortion", limit_expectation(sensor)};
  case LensFault::pixel_too_wide:
    break;
  }
  return {"resolution", "expected pixels that see less than 120 degrees each"};
}

} // namespace

std::optional<LensProblem> lens_problem(const Sensor &sensor) {
  const Lens lens(sensor);
  const std::optional<LensFault> fault = lens_fault(sensor);
  if (fault != LensFault::chip_behind_lens && !(glm::determinant(lens.lens_from_chip()) > 0.0))
    return LensProblem{"chip", "expected the front of the chip towards the lens"};
  return fault ? std::optional(problem_of(*fault, sensor, lens)) : std::nullopt;
}

} // namespace pmdsim
