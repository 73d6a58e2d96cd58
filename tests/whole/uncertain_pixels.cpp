#include "tests/whole/uncertain_pixels.h"

#include "engine/reference/view/lens_model.h"
#include "tests/comparison/seen_plane.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pmdsim::test {
namespace {

// Where the formula is a step or as steep as one, so that rounding of a cosine is much of the light: a diode
// in the plane of a surface without Lambert's cosine, a point in the plane across the axis of a diode whose
// cosine's power is below 1.
bool is_at_step(const glm::dvec3 &point_m, const glm::dvec3 &normal, const Diode &diode,
                Backscatter backscatter) {
  const glm::dvec3 to_diode = glm::normalize(diode.position_m - point_m);
  const bool in_plane = std::abs(glm::dot(normal, to_diode)) < 1e-6;
  const bool at_rim = diode.pattern.kind == Pattern::Kind::cosine && diode.pattern.order < 1.0 &&
                      std::abs(glm::dot(diode.axis, to_diode)) < 1e-3;
  return at_rim || (backscatter == Backscatter::constant && in_plane);
}

// The pixels of a setup of which nothing is asked, a flag each.
class LeftOut {
public:
  LeftOut(const RandomSetup &setup, const Measurement &measured, const reference::Frame &expected)
      : setup_(setup), measured_(measured), expected_(expected),
        triangles_(reference::triangles_in_camera(setup.scene, setup.sensor)), lens_(setup.sensor) {
    for (const Illuminator &illuminator : setup.illuminators)
      for (const Diode &diode : reference::diodes_in_camera(illuminator, setup.sensor))
        diodes_.push_back(diode);
  }

  std::vector<bool> pixels() const {
    std::vector<bool> left_out(setup_.sensor.pixel_count(), false);
    const glm::uvec2 samples = setup_.sensor.resolution * setup_.sensor.samples;
    for (glm::uvec2 sample(0); sample.y < samples.y; ++sample.y)
      for (sample.x = 0; sample.x < samples.x; ++sample.x) {
        const glm::uvec2 pixel = sample / setup_.sensor.samples;
        if (is_uncertain(sample, std::size_t{sample.y} * samples.x + sample.x))
          left_out[std::size_t{pixel.y} * setup_.sensor.resolution.x + pixel.x] = true;
      }
    for (std::size_t pixel = 0; pixel < left_out.size(); ++pixel)
      left_out[pixel] = left_out[pixel] || is_unknown(pixel);
    return left_out;
  }

private:
  bool is_uncertain(const glm::uvec2 &sample, std::size_t index) const {
    const std::uint32_t id = expected_.sample_triangle_id[index];
    if (id == no_id)
      return false;
    const std::size_t words = (diodes_.size() + 31) / 32;
    for (std::size_t word = index * words; word < (index + 1) * words && !expected_.sample_visibility.empty();
         ++word)
      if (measured_.sample_visibility[word] != expected_.sample_visibility[word])
        return true;
    const SeenPlane plane = plane_of(id, setup_.scene, setup_.sensor, triangles_);
    const glm::dvec3 point_m = plane.meeting_point_m(*lens_.sample_ray(sample));
    return std::ranges::any_of(diodes_, [&](const Diode &diode) {
      return is_at_step(point_m, plane.normal, diode, setup_.backscatter);
    });
  }

  // Light that is beyond a float, or cancels so far that rounding shows in the reference's double.
  bool is_unknown(std::size_t pixel) const {
    return std::ranges::any_of(expected_.returns, [&](const reference::FrameReturn &of_frequency) {
      const double rounding_turns = (1.0 + expected_.range_m[pixel] / of_frequency.ambiguity_m) * 0x1p-52;
      const double amplitude = of_frequency.amplitude[pixel];
      return amplitude > 0 &&
             (amplitude < 1e-30 || of_frequency.condition[pixel] * rounding_turns * of_frequency.ambiguity_m >
                                       0.1 * setup_.max_error_m);
    });
  }

  const RandomSetup &setup_;
  const Measurement &measured_;
  const reference::Frame &expected_;
  std::vector<reference::CameraTriangle> triangles_;
  reference::LensModel lens_;
  std::vector<Diode> diodes_;
};

} // namespace

std::vector<bool> uncertain_pixels(const RandomSetup &setup, const Measurement &measured,
                                   const reference::Frame &expected) {
  return LeftOut(setup, measured, expected).pixels();
}

} // namespace pmdsim::test
