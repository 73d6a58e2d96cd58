#include "engine/reference/bounce/path_tracer.h"

#include "engine/reference/view/surface_colours.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace pmdsim::reference {

namespace {

// From this flight on a path ends at random, as often as light does.
constexpr std::uint32_t first_random_flight = 3;
// So that paths end where surfaces reflect all light.
constexpr double most_survival = 0.999;

// Unit length, its density the cosine to the unit vector `normal` over pi.
glm::dvec3 cosine_direction(const glm::dvec3 &normal, PathNumbers &numbers) {
  const double sine_squared = numbers.next();
  const double angle_rad = full_turn_rad * numbers.next();
  // Away from the normal by at least 54 degrees.
  const glm::dvec3 size = glm::abs(normal);
  const glm::dvec3 aside = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                           : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                : glm::dvec3(0, 0, 1);
  const glm::dvec3 u = glm::normalize(glm::cross(aside, normal)), v = glm::cross(normal, u);
  const double sine = std::sqrt(sine_squared);
  return sine * std::cos(angle_rad) * u + sine * std::sin(angle_rad) * v +
         std::sqrt(1.0 - sine_squared) * normal;
}

} // namespace

PathTracer::PathTracer(const Scene &scene, const std::vector<CameraTriangle> &triangles,
                       const std::vector<Light> &lights, Shadows shadows, const Bounces &bounces)
    : scene_(scene), caster_(triangles, std::bind_front(is_there, std::cref(scene))),
      shadows_(shadows != Shadows::off), most_flights_(bounces.count) {
  double sum_w_sr = 0.0;
  for (const Light &light : lights)
    for (const Diode &diode : light.diodes)
      if (diode.intensity_w_sr > 0) {
        sum_w_sr += diode.intensity_w_sr;
        diodes_.push_back(
            {&diode, light.phase_turns, light.modulation_depth, diode.intensity_w_sr, sum_w_sr});
      }
  for (ShiningDiode &diode : diodes_) {
    diode.share /= sum_w_sr;
    diode.share_up_to /= sum_w_sr;
  }
}

void PathTracer::trace(const SurfacePoint &seen, PathNumbers &numbers, std::vector<LightPath> &paths) const {
  if (diodes_.empty())
    return;
  Way way{seen, glm::length(seen.position_m), seen.lens_gain};
  for (std::uint32_t flight = 1; flight <= most_flights_; ++flight) {
    const double survival = flight < first_random_flight ? 1.0 : std::min(way.at.reflectivity, most_survival);
    if (survival < 1.0 && numbers.next() >= survival)
      return;
    // Directions are as frequent as their cosine counts, which leaves rho of rho/pi times the cosine.
    way.throughput *= way.at.reflectivity / survival;
    if (way.throughput == 0 || !fly(way, numbers))
      return;
    add_light(way, numbers, paths);
  }
}

bool PathTracer::fly(Way &way, PathNumbers &numbers) const {
  const glm::dvec3 direction = cosine_direction(way.at.normal, numbers);
  const auto hit = caster_.nearest({way.at.position_m, way.at.normal}, direction);
  if (!hit)
    return false;
  const CameraTriangle &triangle = caster_.triangles()[hit->id];
  const glm::dvec3 front = glm::normalize(triangle.front());
  const bool back_hit = glm::dot(front, direction) > 0;
  if (back_hit && !triangle.double_sided)
    return false;
  way.length_m += glm::length(hit->position_m - way.at.position_m);
  way.at = {hit->position_m, back_hit ? -front : front, reflectivity(scene_, hit->id, hit->weights), 1.0};
  return true;
}

void PathTracer::add_light(const Way &way, PathNumbers &numbers, std::vector<LightPath> &paths) const {
  const ShiningDiode &chosen = choose_diode(numbers.next());
  const LightReturn returned = light_return(way.at, *chosen.diode, Backscatter::lambert);
  const double weight_w_m2_sr = way.throughput * returned.weight_w_m2_sr / chosen.share;
  if (weight_w_m2_sr == 0)
    return;
  if (shadows_ && !caster_.is_free({way.at.position_m, way.at.normal}, chosen.diode->position_m))
    return;
  paths.push_back(
      {way.length_m + returned.diode_range_m, weight_w_m2_sr, chosen.phase_turns, chosen.modulation_depth});
}

const PathTracer::ShiningDiode &PathTracer::choose_diode(double number) const {
  const auto beyond = std::ranges::upper_bound(diodes_, number, {}, &ShiningDiode::share_up_to);
  return beyond == diodes_.end() ? diodes_.back() : *beyond; // by rounding, the shares may end below 1
}

} // namespace pmdsim::reference
