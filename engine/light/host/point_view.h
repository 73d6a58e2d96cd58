#pragma once
// The samples of a vector as a run of sources sees them: Point and ReferencePath of shaders/light/sum.glsl.

#include "engine/light/host/vector_samples.h"
#include "engine/model/wide_lanes.h"

#include <cmath>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// From the run's reference point, m.
struct PointView {
  Floats position[3], rho;
  Floats normal[3], height; // turned to the lens; of the reference point over the surface
  Wide range, detour;       // of the point from the lens; how much farther it is from the reference point
};

inline double exact(const shader::vec4 &hi, const shader::vec4 &lo, int k) {
  return static_cast<double>(hi[k]) + static_cast<double>(lo[k]);
}

// The k-th float of the plane of each sample's shape.
inline Floats of_planes(const shader::TrianglePlane *planes, const VectorSamples &samples, int k) {
  constexpr int words = sizeof(shader::TrianglePlane) / sizeof(float);
  return gathered(reinterpret_cast<const float *>(planes), load<Ints>(samples.shape) * words + k);
}

inline PointView see_points(const VectorSamples &samples, const shader::TrianglePlane *planes,
                            const shader::LightRun &run, bool with_surface) {
  PointView view{};
  Wide range2{}, rho2{};
  for (int k = 0; k < 3; ++k) {
    const Wide point = load_wide(samples.point_m[k]);
    const Wide away = point - exact(run.reference_hi, run.reference_lo, k);
    range2 = range2 + point * point;
    rho2 = rho2 + away * away;
    view.position[k] = narrow(away);
  }
  view.range = root(range2);
  const Wide rho = root(rho2);
  view.rho = narrow(rho);
  view.detour = rho - view.range;
  if (!with_surface)
    return view;
  Floats from_sample = all(0.0f), over_lens = -of_planes(planes, samples, 3);
  float reference2 = 0.0f;
  for (int k = 0; k < 3; ++k) {
    view.normal[k] = of_planes(planes, samples, k);
    from_sample -= view.normal[k] * view.position[k];
    over_lens += view.normal[k] * run.reference_hi[k];
    reference2 += run.reference_hi[k] * run.reference_hi[k];
  }
  // By the way that is shorter, which cancels less: over the lens's height, or from the sample.
  view.height = view.rho < std::sqrt(reference2) ? from_sample : over_lens;
  return view;
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
