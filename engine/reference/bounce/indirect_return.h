#pragma once
// What bounces to a pixel, and how far it is off: the mean of replicates that know nothing of each other, so
// that their scatter tells its error.

#include "engine/reference/bounce/path_tracer.h"
#include "engine/reference/light/return_sum.h"

#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

namespace pmdsim::reference {

inline constexpr std::uint32_t replicate_count = 16;

// At one modulation frequency.
struct IndirectReturn {
  MeanReturn mean;
  // Of mean.z's parts.
  double real_variance = 0.0, imaginary_variance = 0.0, covariance = 0.0;

  // Of |mean.z|, whatever the direction.
  double standard_error() const;
  // Of the component of mean.z at right angles to `z`, not 0.
  double standard_error_across(const std::complex<double> &z) const;
};

// Beside Sensor::modulation_hz, over at least `paths` paths. `seen` holds what each of the pixel's samples
// sees; `pixel` is its number in the sensor, from which all chance follows.
std::vector<IndirectReturn> indirect_returns(const Sensor &sensor, const PathTracer &tracer,
                                             const std::vector<std::optional<SurfacePoint>> &seen,
                                             std::uint32_t pixel, std::uint32_t paths);

} // namespace pmdsim::reference
