#pragma once
// The places of surfaces that the samples of a frame see, by the shapes that the frame found there.

#include "engine/lens/lens.h"
#include "engine/model/measurement.h"
#include "engine/model/scene.h"
#include "engine/surfaces/elements.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace pmdsim {

// What a ray of the lens sees on a shape's plane.
struct SeenPlace {
  SurfacePlace place;  // its normal turned to the lens
  double range_m;      // from the lens
  double reflectivity; // there
  double lens_gain;    // what vignetting leaves
};

class SeenPlaces {
public:
  // The measurement and the scene have to outlive this. Places count from `origin_m` of the world.
  SeenPlaces(const Scene &scene, const Sensor &sensor, const Measurement &measurement,
             const glm::dvec3 &origin_m);

  // The frame's samples, S x S of each pixel, row by row; `sample` counts their columns and rows.
  std::uint32_t columns() const { return samples_ * resolution_.x; }
  std::uint32_t rows() const { return samples_ * resolution_.y; }
  std::uint32_t samples_of_pixel() const { return samples_ * samples_; }
  // The pixel of a sample, in the order of rows.
  std::size_t pixel_of(const glm::uvec2 &sample) const {
    return std::size_t{sample.y / samples_} * resolution_.x + sample.x / samples_;
  }

  // The shape that a sample sees; no_id where it sees nothing.
  std::uint32_t shape(const glm::uvec2 &sample) const;
  // Where it sees it; nothing where its ray runs along that shape's plane.
  std::optional<SeenPlace> at(const glm::uvec2 &sample) const;

  // Whether what arrives from elsewhere is continuous from one sample to its neighbour, but for what a small
  // tilt changes: they see one plane from the same side, or one object where it is smooth.
  bool are_continuous(const glm::uvec2 &a, const glm::uvec2 &b) const;

private:
  struct Plane {
    glm::dvec3 normal{0.0}; // camera frame, turned to the lens; zero where the shape has no area
    double offset_m = 0.0;
  };
  Plane plane_of(std::uint32_t shape) const;
  std::optional<glm::dvec3> ray(const glm::uvec2 &sample) const;
  // Whether a surface goes on from one sample's plane to its neighbour's, without a step.
  bool is_unbroken(const glm::uvec2 &a, const glm::uvec2 &b) const;

  const Scene &scene_;
  const Measurement &measurement_;
  Lens lens_;
  Pose world_from_camera_;
  glm::dvec3 origin_m_;
  glm::uvec2 resolution_;
  glm::dvec2 fill_factor_;
  Vignetting vignetting_;
  std::uint32_t samples_;
  std::vector<Plane> planes_; // of each shape
};

} // namespace pmdsim
