#pragma once
// The range on a ray at which the model's return has a given phase.

#include "engine/correction/correction.h"
#include "engine/correction/diode_rows.h"
#include "engine/correction/return_loops.h"

#include <optional>
#include <span>

namespace pmdsim {

struct FoundRange {
  double range_m;     // where the search ended
  PixelStatus status; // corrected, no_light or not_converged
};

class RangeSearch {
public:
  RangeSearch(const Sensor &sensor, const std::vector<Illuminator> &illuminators,
              const CorrectionOptions &options);

  double ambiguity_m() const { return ambiguity_m_; }
  ModelReturn model_return(const PointOnRay &at, bool with_normal = false) const;

  // Newton's method, with the derivative of the phase by the paths at first and then by secants; the nearest
  // turn of the phase, from `start` on. Between two ranges where the phase is too short and too long no step
  // leads out.
  FoundRange nearest(const PointOnRay &start, double phase_rad) const;
  // The same within [least, least + ambiguity).
  FoundRange within(const PointOnRay &start, double phase_rad, double least_m) const;

  // By how much the phase of the mean return of the given points exceeds that at the point.
  double phase_excess_rad(const PointOnRay &at, std::span<const PointOnRay> around) const;
  // How the range that has the same phase changes with the normal, m for each unit of it.
  glm::dvec3 range_per_normal_m(const PointOnRay &at) const;

private:
  std::vector<DiodeRow> rows_;
  TapDemodulation demodulation_;
  double turns_per_m_, ambiguity_m_;
  bool lambert_, vignetting_;
};

} // namespace pmdsim
