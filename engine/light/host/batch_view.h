#pragma once
// How the samples of a vector lie to a run of sources and to its batches, with lengths in units of each
// sample's distance from the run's reference point.
#include "engine/light/host/laws.h"
#include "engine/light/host/vector_samples.h"

#include <cmath>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// Camera frame, from the run's reference point.
struct RunView {
  double from_reference_m[3][lanes];
  double height_m[lanes]; // the reference point's, over the surface
  Floats rho_m, inverse_m;
};

// In a batch's frame, from the run's reference point. Heights, normals and detours are in units of rho.
struct BatchView {
  Floats x_m, y_m, along_m;          // `along_m` counts from the batch's plane
  Floats normal_x, normal_y, height; // `height`: the reference point's foot in the plane, over the surface
  Floats twice_x, twice_y, detour;   // terms of u: by the source's place, and the same for all sources
  Floats inverse2_m2;                // the factor of the source's square distance in u
  Floats along;                      // W has its power, where W is a power of lengths
};

inline RunView view_from(const VectorSamples &samples, const RunOfBatches &run) {
  RunView view;
  alignas(vector_bytes) float rho[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    double rho2 = 0.0, height = -samples.offset_m[lane];
    for (int k = 0; k < 3; ++k) {
      const double away = samples.point_m[k][lane] - run.reference_m[k];
      view.from_reference_m[k][lane] = away;
      rho2 += away * away;
      height += samples.normal[k][lane] * run.reference_m[k];
    }
    view.height_m[lane] = height;
    rho[lane] = static_cast<float>(std::sqrt(rho2));
  }
  view.rho_m = load<Floats>(rho);
  view.inverse_m = 1.0f / view.rho_m;
  return view;
}

inline BatchView view_from(const VectorSamples &samples, const RunView &run, const SourceBatch &batch) {
  alignas(vector_bytes) float place[3][lanes], normal[2][lanes], height[lanes], detour[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    double in_frame_m[3] = {}, turned[3] = {};
    for (int row = 0; row < 3; ++row)
      for (int k = 0; k < 3; ++k) {
        in_frame_m[row] += batch.rotation[row][k] * run.from_reference_m[k][lane];
        turned[row] += batch.rotation[row][k] * samples.normal[k][lane];
      }
    place[0][lane] = static_cast<float>(in_frame_m[0]);
    place[1][lane] = static_cast<float>(in_frame_m[1]);
    place[2][lane] = static_cast<float>(in_frame_m[2] - batch.along_m);
    normal[0][lane] = static_cast<float>(turned[0]);
    normal[1][lane] = static_cast<float>(turned[1]);
    height[lane] = static_cast<float>(run.height_m[lane] + batch.along_m * turned[2]);
    detour[lane] = static_cast<float>(-2.0 * batch.along_m * in_frame_m[2]);
  }
  const Floats x = load<Floats>(place[0]), y = load<Floats>(place[1]), along = load<Floats>(place[2]),
               inverse = run.inverse_m, inverse2 = inverse * inverse;
  return {x,
          y,
          along,
          load<Floats>(normal[0]) * inverse,
          load<Floats>(normal[1]) * inverse,
          load<Floats>(height) * inverse,
          -2.0f * x * inverse2,
          -2.0f * y * inverse2,
          load<Floats>(detour) * inverse2,
          inverse2,
          larger(along, all(0.0f)) * inverse};
}

// An upper bound of |u| over a run's sources. One batch is bound by how the sample lies to its plane, several
// by the sample's distance.
inline Floats largest_u(const VectorSamples &samples, const RunOfBatches &run, const RunView &view) {
  constexpr float slack = 1.00001f;
  if (run.count != 1) {
    const Floats t = run.radius_m * view.inverse_m;
    return slack * t * (t + 2.0f);
  }
  const SourceBatch &batch = run.batches[0];
  const BatchView at = view_from(samples, view, batch);
  const float along_m = std::abs(static_cast<float>(batch.along_m)), radius_m = batch.radius_m;
  const Floats across = root(larger(at.x_m * at.x_m + at.y_m * at.y_m, all(tiny)));
  const Floats product = across * radius_m + (absolute(at.along_m) + along_m) * along_m;
  return slack * at.inverse2_m2 * (radius_m * radius_m + along_m * along_m + 2.0f * product);
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
