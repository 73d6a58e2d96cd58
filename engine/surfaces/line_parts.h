#pragma once
// Parts of lines over a hemisphere that lie in one facet each, and what they count.

#include "engine/surfaces/hemisphere_scan.h"
#include "engine/surfaces/surface_frame.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {

// A part of a line in a facet; from `at_m`, all linear along `way_m`.
struct FacetPart {
  glm::vec2 at_m, way_m;
  Linear u, v;
  std::uint32_t face;
  float scale;
};

// Parts of lines, cut so short that one point stands for each; their storage serves the next place.
class LineParts {
public:
  float weight = 0.0f; // of the strip about the line, over pi

  std::size_t size() const { return count_; }
  void clear() { count_ = 0; }

  void add(const FacetPart &part, float from, float to) {
    constexpr float longest_rad = 0.15f;
    const glm::vec2 low = part.at_m + from * part.way_m, high = part.at_m + to * part.way_m;
    if (cross(low, high) > longest_rad * glm::dot(low, high)) {
      const float middle = 0.5f * (from + to);
      if (from < middle && middle < to) {
        add(part, from, middle);
        add(part, middle, to);
        return;
      }
    }
    if (count_ == face_.size())
      grow();
    face_[count_] = part.face;
    low_x_[count_] = low.x;
    low_y_[count_] = low.y;
    high_x_[count_] = high.x;
    high_y_[count_] = high.y;
    low_u_[count_] = part.u(from);
    low_v_[count_] = part.v(from);
    high_u_[count_] = part.u(to);
    high_v_[count_] = part.v(to);
    weight_[count_] = weight * part.scale;
    ++count_;
  }

  void finish(Sightings &sightings) const {
    for (auto *values : {&sightings.u, &sightings.v, &sightings.length_m, &sightings.share})
      values->resize(count_);
    sightings.face.assign(face_.begin(), face_.begin() + static_cast<std::ptrdiff_t>(count_));
    // What is written lies apart from what is read, which the compiler cannot know.
    const float *__restrict low_x = low_x_.data(), *__restrict low_y = low_y_.data(),
                            *__restrict high_x = high_x_.data(), *__restrict high_y = high_y_.data(),
                            *__restrict low_u = low_u_.data(), *__restrict low_v = low_v_.data(),
                            *__restrict high_u = high_u_.data(), *__restrict high_v = high_v_.data(),
                            *__restrict weights = weight_.data();
    float *__restrict u = sightings.u.data(), *__restrict v = sightings.v.data(),
                      *__restrict length_m = sightings.length_m.data(),
                      *__restrict share = sightings.share.data();
    for (std::size_t i = 0; i < count_; ++i) {
      const float lx = low_x[i], ly = low_y[i], hx = high_x[i], hy = high_y[i];
      const float low_m = std::sqrt(lx * lx + ly * ly), high_m = std::sqrt(hx * hx + hy * hy);
      const float sine = (lx * hy - ly * hx) / (low_m * high_m);
      // The direction in the middle, and the part of the way from low to high at which it is met.
      const float mx = lx / low_m + hx / high_m, my = ly / low_m + hy / high_m;
      const float from = lx * my - ly * mx, to = mx * hy - my * hx;
      const float middle = std::min(std::max(from / std::max(from + to, 1e-30f), 0.0f), 1.0f);
      const float x = lx + middle * (hx - lx), y = ly + middle * (hy - ly),
                  middle_m = std::sqrt(x * x + y * y);
      // Means along the part, by Simpson's rule: each direction counts as sin^2 of its angle.
      const float low_sine = ly / low_m, middle_sine = y / middle_m, high_sine = hy / high_m;
      const float at_low = low_sine * low_sine, at_middle = 4.0f * middle_sine * middle_sine,
                  at_high = high_sine * high_sine, all = 1.0f / (at_low + at_middle + at_high);
      const float t = all * (at_middle * middle + at_high);
      u[i] = low_u[i] + t * (high_u[i] - low_u[i]);
      v[i] = low_v[i] + t * (high_v[i] - low_v[i]);
      length_m[i] = all * (at_low * low_m + at_middle * middle_m + at_high * high_m);
      // The integral of sin^2 of the angle over the part: half of the angle less its sine, for which that
      // cubed over 6 stands, and sin^2 in the middle times the sine.
      share[i] = weights[i] * (sine * sine * sine / 12.0f + middle_sine * middle_sine * sine);
    }
  }

private:
  void grow() {
    const std::size_t size = std::max<std::size_t>(1024, 2 * count_);
    face_.resize(size);
    for (auto *values :
         {&low_x_, &low_y_, &high_x_, &high_y_, &low_u_, &low_v_, &high_u_, &high_v_, &weight_})
      values->resize(size);
  }

  std::size_t count_ = 0;
  std::vector<std::uint32_t> face_;
  std::vector<float> low_x_, low_y_, high_x_, high_y_, low_u_, low_v_, high_u_, high_v_, weight_;
};

} // namespace pmdsim
