#include "engine/lens/lens_fault.h"

#include "engine/lens/lens.h"

#include <algorithm>
#include <array>

namespace pmdsim {
namespace {

// What is wrong with the ray through a place of the image.
std::optional<LensFault> fault_at(const Lens &lens, const glm::dvec2 &pixel) {
  if (lens.ray(lens.on_chip_m(pixel)))
    return std::nullopt;
  return lens.folds() ? LensFault::distortion_folds : LensFault::beyond_model;
}

// Along the image's borders, and in a net over it: tangential terms may fold inside, too.
std::optional<LensFault> distortion_fault(const Lens &lens, const glm::uvec2 &last) {
  std::optional<LensFault> fault;
  const auto look = [&](double column, double row) {
    if (!fault)
      fault = fault_at(lens, {column, row});
  };
  for (std::uint32_t column = 0; column <= last.x; ++column) {
    look(column, 0);
    look(column, last.y);
  }
  for (std::uint32_t row = 0; row <= last.y; ++row) {
    look(0, row);
    look(last.x, row);
  }
  constexpr int net = 64;
  for (int i = 1; i < net; ++i)
    for (int j = 1; j < net; ++j)
      look(last.x * (i / double{net}), last.y * (j / double{net}));
  return fault;
}

// Whether a pixel sees a ray 60 degrees or more from the mean of its rays. The largest are few, or on a
// regular net.
bool has_too_wide_pixel(const Lens &lens, const glm::uvec2 &resolution) {
  const glm::uvec2 steps = glm::min(resolution, glm::uvec2(64));
  for (glm::uvec2 step(0); step.y < steps.y; ++step.y)
    for (step.x = 0; step.x < steps.x; ++step.x) {
      const glm::dvec2 pixel(step * (resolution - 1u) / glm::max(steps - 1u, glm::uvec2(1)));
      // Corners, middles of the sides, and the centre, without which a view of nearly everything looks narrow
      // from behind.
      std::array<glm::dvec3, 9> rays;
      glm::dvec3 mean(0.0);
      for (std::size_t k = 0; k < rays.size(); ++k)
        mean += rays[k] = *lens.ray(lens.on_chip_m(pixel + 0.5 * glm::dvec2(k % 3, k / 3)));
      mean = glm::normalize(mean);
      if (!std::ranges::all_of(rays, [&](const glm::dvec3 &ray) { return glm::dot(ray, mean) > 0.5; }))
        return true;
    }
  return false;
}

} // namespace

std::optional<LensFault> lens_fault(const Sensor &sensor) {
  const Lens lens(sensor);
  const glm::uvec2 &last = sensor.resolution;
  for (const glm::uvec2 corner : {glm::uvec2(0), glm::uvec2(last.x, 0), glm::uvec2(0, last.y), last})
    if (!((lens.lens_from_chip() * glm::dvec3(lens.on_chip_m(corner), 1.0)).z > 0.0))
      return LensFault::chip_behind_lens;
  if (!sensor.has_distortion())
    return std::nullopt;
  if (const auto fault = distortion_fault(lens, last))
    return fault;
  return has_too_wide_pixel(lens, last) ? std::optional(LensFault::pixel_too_wide) : std::nullopt;
}

} // namespace pmdsim
