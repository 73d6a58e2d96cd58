#pragma once
// The light that leaves a side of a facet.

#include "engine/radiosity/phasor.h"

namespace pmdsim {

// Linear in the weights u and v of the second and the third corner of the scene's triangle that a facet lies
// in: at + u by_u + v by_v.
struct TriangleLight {
  Phasor at, by_u, by_v;

  TriangleLight &operator+=(const TriangleLight &b) {
    at += b.at;
    by_u += b.by_u;
    by_v += b.by_v;
    return *this;
  }
};

inline TriangleLight operator*(float s, const TriangleLight &a) { return {s * a.at, s * a.by_u, s * a.by_v}; }

inline Phasor light_at(const TriangleLight &light, float u, float v) {
  return light.at + u * light.by_u + v * light.by_v;
}

// As the loops of line_light_kernel.cpp read it: four floats, and four more.
struct alignas(32) FaceLight {
  TriangleLight leaving;
  float missed = 0.0f; // |z| at the centre
};

} // namespace pmdsim
