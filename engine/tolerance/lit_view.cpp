#include "engine/tolerance/lit_view.h"

namespace pmdsim {

TolerancedDiode toleranced(const Diode &diode, double phase_turns, std::uint32_t illuminator,
                           const glm::dmat3 &illuminator_axes) {
  const auto across = [&](const glm::dvec3 &direction) {
    return direction - glm::dot(direction, diode.axis) * diode.axis;
  };
  constexpr double along_axis = 1e-3; // x is hardly across the axis
  const glm::dvec3 of_x = across(illuminator_axes[0]);
  const glm::dvec3 towards_x =
      glm::normalize(glm::length(of_x) > along_axis ? of_x : across(illuminator_axes[1]));
  return {diode, phase_turns, illuminator, illuminator_axes, towards_x, glm::cross(diode.axis, towards_x)};
}

} // namespace pmdsim
