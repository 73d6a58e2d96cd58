#include "engine/light/precise_diagrams.h"

#include "engine/light/diagram_tables.h"
#include "engine/vulkan/float_pair.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace pmdsim {
namespace {

constexpr double full_turn_rad = 2.0 * std::numbers::pi;
// The rounding of a direction, as a part of its angles.
constexpr double precise_direction_rounding = 16 * 0x1p-45;
// Straight behind the diode rounding must not lead beyond the last angle: there the table goes on.
constexpr double beyond_half_a_turn = 0.51;

bool ends_behind(const Diagram &diagram) {
  return std::abs(diagram.theta_rad.back() - std::numbers::pi) < 1e-9;
}

std::vector<double> theta_turns(const Diagram &diagram) {
  std::vector<double> turns;
  for (const double theta_rad : diagram.theta_rad)
    turns.push_back(theta_rad / full_turn_rad);
  if (ends_behind(diagram))
    turns.push_back(beyond_half_a_turn);
  return turns;
}

std::vector<double> phi_turns(const Diagram &diagram) {
  std::vector<double> turns;
  if (diagram.phi_rad.size() == 1)
    return turns;
  for (const double phi_rad : diagram.phi_rad)
    turns.push_back((phi_rad - diagram.phi_rad.front()) / full_turn_rad);
  turns.push_back(1.0);
  return turns;
}

} // namespace

std::uint32_t PreciseDiagrams::first_of(const std::shared_ptr<const Diagram> &diagram) {
  const auto [found, is_new] = firsts_.try_emplace(diagram, static_cast<std::uint32_t>(values_.size()));
  if (!is_new)
    return found->second;
  const std::vector<double> thetas = theta_turns(*diagram), phis = phi_turns(*diagram);
  values_.emplace_back(thetas.size(), phis.size());
  for (const std::vector<double> *angles : {&thetas, &phis})
    for (const double turns : *angles)
      values_.push_back(float_pair(turns));
  const std::size_t columns = diagram->phi_rad.size();
  for (std::size_t phi = 0; phi < std::max<std::size_t>(phis.size(), 1); ++phi)
    for (std::size_t theta = 0; theta < thetas.size(); ++theta) {
      const std::size_t row = std::min(theta, diagram->theta_rad.size() - 1);
      values_.push_back(float_pair(diagram->relative[row * columns + phi % columns]));
    }
  return found->second;
}

double precise_diagram_error(const Diagram &diagram) {
  return precise_direction_rounding * diagram_slope(diagram);
}

} // namespace pmdsim
