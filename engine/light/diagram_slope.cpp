#include "engine/light/diagram_slope.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pmdsim {
namespace {

double slope_in_theta(const Diagram &diagram) {
  const std::size_t columns = diagram.phi_rad.size();
  double slope = 0.0;
  for (std::size_t t = 1; t < diagram.theta_rad.size(); ++t)
    for (std::size_t p = 0; p < columns; ++p) {
      const double change = diagram.relative[t * columns + p] - diagram.relative[(t - 1) * columns + p];
      slope = std::max(slope, std::abs(change) / (diagram.theta_rad[t] - diagram.theta_rad[t - 1]));
    }
  return slope;
}

// Over sin theta.
double slope_in_phi(const Diagram &diagram) {
  const std::size_t columns = diagram.phi_rad.size();
  double slope = 0.0;
  for (std::size_t t = 0; t < diagram.theta_rad.size(); ++t)
    for (std::size_t p = 0; p < columns; ++p) {
      const std::size_t next = (p + 1) % columns;
      const double change = diagram.relative[t * columns + next] - diagram.relative[t * columns + p];
      double step_rad = diagram.phi_rad[next] - diagram.phi_rad[p];
      if (next == 0)
        step_rad += 2.0 * std::numbers::pi;
      if (change != 0.0) // twice, as between the axis and the first row the ratio may be larger
        slope = std::max(slope, 2.0 * std::abs(change) / (step_rad * std::sin(diagram.theta_rad[t])));
    }
  return std::isfinite(slope) ? slope : std::numeric_limits<double>::infinity();
}

} // namespace

double diagram_slope(const Diagram &diagram) {
  return std::numbers::pi * slope_in_theta(diagram) +
         (diagram.phi_rad.size() > 1 ? slope_in_phi(diagram) : 0.0);
}

} // namespace pmdsim
