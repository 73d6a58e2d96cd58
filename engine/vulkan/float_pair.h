#pragma once
// A double as the two floats that shaders take it in: the nearest float and what is left, 48 bits together.

#include <glm/glm.hpp>

namespace pmdsim {

inline glm::vec2 float_pair(double value) {
  const auto hi = static_cast<float>(value);
  return {hi, static_cast<float>(value - static_cast<double>(hi))};
}

struct DoublePair4 {
  glm::vec4 hi;
  glm::vec4 lo;

  explicit DoublePair4(const glm::dvec4 &value) : hi(value), lo(value - glm::dvec4(hi)) {}
  DoublePair4(const glm::dvec3 &xyz, double w) : DoublePair4(glm::dvec4(xyz, w)) {}
};

} // namespace pmdsim
