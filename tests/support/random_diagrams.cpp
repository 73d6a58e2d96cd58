#include "tests/support/random_diagrams.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace pmdsim::test {

std::shared_ptr<const Diagram> random_diagram(Random &random, bool axial) {
  const auto thetas = static_cast<std::uint32_t>(random.uniform(10, 91));
  const auto phis = axial ? 1 : static_cast<std::uint32_t>(random.uniform(2, 25));
  const double squeeze = random.uniform(0.5, 2.0), turn = random.uniform(0.0, 3.0);
  const double unevenness = random.flip() ? 0.0 : 0.4;
  const auto between = [&](std::uint32_t i) { return i + unevenness * random.uniform(-1.0, 1.0); };
  Diagram diagram;
  for (std::uint32_t i = 0; i < phis; ++i)
    diagram.phi_rad.push_back(2.0 * std::numbers::pi * (i > 0 ? between(i) : 0.0) / phis);
  for (std::uint32_t i = 0; i < thetas; ++i) {
    const double place = i > 0 && i + 1 < thetas ? between(i) : i;
    const double theta_rad = 0.5 * std::numbers::pi * place / (thetas - 1);
    diagram.theta_rad.push_back(theta_rad);
    for (const double phi_rad : diagram.phi_rad)
      diagram.relative.push_back(
          std::pow(std::cos(theta_rad), squeeze) *
          (axial ? 1.0 : 1.0 + 0.5 * std::sin(theta_rad) * std::cos(2 * phi_rad + turn)));
  }
  return std::make_shared<const Diagram>(diagram);
}

} // namespace pmdsim::test
