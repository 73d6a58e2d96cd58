#include "engine/multipath/seen_places.h"

#include "engine/surfaces/surface_paint.h"

#include <cmath>

namespace pmdsim {
namespace {

// The weights of a triangle's corners at a place of its plane.
CornerWeights weights_at(const std::array<glm::dvec3, 3> &corners_m, const glm::dvec3 &place_m) {
  const glm::dvec3 ab = corners_m[1] - corners_m[0], ac = corners_m[2] - corners_m[0],
                   ap = place_m - corners_m[0];
  const glm::dvec3 normal = glm::cross(ab, ac);
  const double area2 = glm::dot(normal, normal);
  const double b = glm::dot(glm::cross(ap, ac), normal) / area2,
               c = glm::dot(glm::cross(ab, ap), normal) / area2;
  return {1.0 - b - c, b, c};
}

} // namespace

SeenPlaces::SeenPlaces(const Scene &scene, const Sensor &sensor, const Measurement &measurement,
                       const glm::dvec3 &origin_m)
    : scene_(scene), measurement_(measurement), lens_(sensor), world_from_camera_(sensor.world_from_camera),
      origin_m_(origin_m), resolution_(sensor.resolution), fill_factor_(sensor.fill_factor),
      vignetting_(sensor.vignetting), samples_(sensor.samples) {
  for (std::uint32_t shape = 0; shape < scene.shape_count(); ++shape)
    planes_.push_back(plane_of(shape));
}

SeenPlaces::Plane SeenPlaces::plane_of(std::uint32_t shape) const {
  const Pose camera_from_world = inverse(world_from_camera_);
  const auto corner = [&](std::uint32_t vertex) {
    return camera_from_world.point(scene_.positions_m[vertex]);
  };
  glm::dvec3 normal, on_plane_m;
  if (scene_.is_disc(shape)) {
    on_plane_m = corner(scene_.discs[shape - scene_.triangles.size()].vertex);
    normal = -on_plane_m; // it faces the lens
  } else {
    const auto &[a, b, c] = scene_.triangles[shape].vertices;
    on_plane_m = corner(a);
    normal = glm::cross(corner(b) - on_plane_m, corner(c) - on_plane_m);
  }
  const double length = glm::length(normal);
  if (!(length > 0.0))
    return {};
  normal /= length;
  const double offset_m = glm::dot(normal, on_plane_m);
  return offset_m > 0.0 ? Plane{-normal, -offset_m} : Plane{normal, offset_m};
}

std::uint32_t SeenPlaces::shape(const glm::uvec2 &sample) const {
  const auto &shapes = samples_ == 1 ? measurement_.triangle_id : measurement_.sample_triangle_id;
  return shapes[std::size_t{sample.y} * columns() + sample.x];
}

std::optional<glm::dvec3> SeenPlaces::ray(const glm::uvec2 &sample) const {
  const glm::dvec2 pixel(sample / samples_), k(sample % samples_);
  const glm::dvec2 from_centre = fill_factor_ * ((k + 0.5) / static_cast<double>(samples_) - 0.5);
  return lens_.ray(lens_.on_chip_m(pixel + 0.5 + from_centre));
}

std::optional<SeenPlace> SeenPlaces::at(const glm::uvec2 &sample) const {
  const auto ray = this->ray(sample);
  const std::uint32_t shape = this->shape(sample);
  if (shape == no_id)
    return std::nullopt;
  const Plane &plane = planes_[shape];
  const double facing = ray ? glm::dot(plane.normal, *ray) : 0.0;
  if (!(facing < 0.0))
    return std::nullopt;
  const double range_m = plane.offset_m / facing;
  const glm::dvec3 world_m = world_from_camera_.point(range_m * *ray);
  CornerWeights weights(1.0, 0.0, 0.0);
  if (!scene_.is_disc(shape) && scene_.surfaces[scene_.surface_of(shape)].paint) {
    const auto &[a, b, c] = scene_.triangles[shape].vertices;
    weights = weights_at({scene_.positions_m[a], scene_.positions_m[b], scene_.positions_m[c]}, world_m);
  }
  return SeenPlace{{world_m - origin_m_, world_from_camera_.direction(plane.normal)},
                   range_m,
                   reflectivity_at(scene_, shape, weights),
                   vignetting_ == Vignetting::cos4 ? std::pow(std::max(ray->z, 0.0), 4.0) : 1.0};
}

bool SeenPlaces::are_continuous(const glm::uvec2 &a, const glm::uvec2 &b) const {
  const std::uint32_t of_a = shape(a), of_b = shape(b);
  if (of_a == of_b)
    return true;
  if (of_a == no_id || of_b == no_id || scene_.is_disc(of_a) || scene_.is_disc(of_b))
    return false;
  constexpr double same_direction = 1.0 - 1e-10, same_place = 1e-6;
  const Plane &p = planes_[of_a], &q = planes_[of_b];
  const double cosine = glm::dot(p.normal, q.normal);
  if (cosine > same_direction && std::abs(p.offset_m - q.offset_m) <= same_place * std::abs(p.offset_m))
    return true;
  constexpr double smooth = 0.98; // of some 11 degrees
  return cosine > smooth && scene_.object_of(of_a) == scene_.object_of(of_b) && is_unbroken(a, b);
}

bool SeenPlaces::is_unbroken(const glm::uvec2 &a, const glm::uvec2 &b) const {
  constexpr double slope = 0.35; // from the one plane to the other
  const auto to_a = ray(a), to_b = ray(b);
  if (!to_a || !to_b)
    return false;
  const Plane &p = planes_[shape(a)], &q = planes_[shape(b)];
  const auto on = [](const Plane &plane, const glm::dvec3 &along) {
    return plane.offset_m / glm::dot(plane.normal, along) * along;
  };
  const glm::dvec3 at_a = on(p, *to_a), at_b = on(q, *to_b), beside_a = on(p, *to_b), beside_b = on(q, *to_a);
  return glm::distance(at_b, beside_a) <= slope * glm::distance(at_a, beside_a) &&
         glm::distance(at_a, beside_b) <= slope * glm::distance(at_b, beside_b);
}

} // namespace pmdsim
