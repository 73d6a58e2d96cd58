#pragma once
// The form of a sum over one run of sources, as plain data for the host's loops: what the shaders have in
// specialization constants.

#include "engine/model/exponent.h"
#include "shaders/shared/interface.h"

#include <cstdint>

namespace pmdsim {

struct RunForm {
  const shader::LightRun *run;
  float path_difference_m; // at most, between a source's way and the reference point's
  std::uint32_t powers, moments;
  bool lambert;     // a weight has the cosine of the surface
  Exponent cosines; // of each source's axis, in a weight
  bool coplanar, phased;
  bool diagrams, beam_edges, beams; // rounding that counts apart (shaders/light/sum.glsl: terms_of)
  // Sums beforehand; nullptr: none. The coefficients stand in the order in which Horner's rule takes them.
  const shader::PointPolynomials *beforehand;
  const float *coefficients;
  std::uint32_t dimensions;
  bool tests_facing; // only samples that face all sources are summed so
};

} // namespace pmdsim
