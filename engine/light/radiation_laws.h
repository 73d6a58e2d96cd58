#pragma once
// Radiation laws, J of the paper's eq. 5, a row each: all that the sum, its error bounds and the reduction of
// the diodes ask of a law. The laws as the device computes them stand in shaders/light/radiation_laws.glsl,
// their names in setups in engine/model/illuminator.h.

#include "engine/light/camera_light.h"
#include "engine/light/diagram_tables.h"
#include "engine/light/precise_diagrams.h"
#include "engine/model/accuracy.h"
#include "shaders/shared/interface.h"

#include <optional>
#include <span>
#include <vector>

namespace pmdsim {

// Up to here the host multiplies a whole power out, beside other laws.
inline constexpr std::uint32_t largest_multiplied_power = 8;

// A form of the sum, by what it knows of J.
struct LawForm {
  std::uint32_t pattern = shader::pattern_any; // shader::pattern_*
  // n where J is taken as a factor of its own and (1 / r)^n, as a power of a cosine is one of lengths.
  double range_powers = 0.0;

  bool operator==(const LawForm &) const = default;
};

// The sum in which J is rounded.
struct LawRounding {
  std::uint32_t pattern;        // its form, shader::pattern_*
  double radius_over_range;     // as in SourceGroups
  double least_cosine;          // to the axis of any diode, of all that it lights
  bool beams_are_apart = false; // beam_rounding has what narrow beams' J is off by
};

// How the light ends beyond 45 degrees off a diode's axis (beam_edge_terms in shaders/light/sum.glsl).
struct BeamEdge {
  double steepness; // J's relative error over that of the cosine, at most
  double power;     // J falls like this power of the cosine, >= 1, or more slowly
};

// How the reduction expands J about a place (engine/reduction/dominant_moments.h).
struct LawSeries {
  std::optional<double> order; // of a cosine around the axis; nothing: J is 1
};

// A law claims nothing for members that are left out: with the first three alone it is summed in mode exact
// only, with no bound of its error, and its diodes are never reduced.
struct RadiationLaw {
  Pattern::Kind kind;
  // GroupSource::order of its diodes, by which shaders/light/radiation_laws.glsl knows the law: below 0, as
  // numbers from 0 on are orders of cosines.
  float number;
  // Writes what J is made of into a diode's record, which has the law's number.
  void (*describe)(const Diode &, DiagramTables &, shader::GroupSource &) = nullptr;
  // Likewise into the one that is summed in fp64, beside what rounding took from the other; left out:
  // nothing.
  void (*describe_precisely)(const Diode &, PreciseDiagrams &, shader::PreciseSource &) = nullptr;
  // The cheapest form for diodes that are alike in this; left out: pattern_any.
  LawForm (*form)(const Pattern &) = nullptr;
  // And the form beside other laws: shader::pattern_general, or pattern_any where that does not know the law.
  std::uint32_t form_beside_others = shader::pattern_any;
  // The largest slope of ln J over what is visible, per radian, and such that its square bounds the
  // curvature. Left out: infinite, and no pixel of several samples is summed at fewer points.
  double (*slope)(const Diode &, const std::vector<VisibleBox> &) = nullptr;
  // The error of J, relative to itself, u; `order` is the largest GroupSource::order.
  double (*rounding_u)(float order, const LawRounding &) = nullptr;
  // Where those are apart: the error of a narrow beam's J, u.
  BeamError (*beam_rounding)(float order, const LawRounding &) = nullptr;
  // The absolute error of J beside that, of a group's radius over its range; left out: 0. Infinite where it
  // has no bound.
  double (*error)(const Pattern &, DiagramTables &, double radius_over_range) = nullptr;
  double (*precise_error)(const Pattern &) = nullptr; // in fp64
  // J in double; the way from the diode, of any length. Left out: sums over its diodes are not interpolated.
  double (*value)(const Diode &, const glm::dvec3 &way) = nullptr;
  // Why an error cannot be promised where there is no bound.
  const char *unbounded = "a diode has a radiation law whose rounding has no bound";
  // Where beams have a rim: how steep it is, for GroupSource::order, nothing where it is an edge; and J's own
  // rounding there, over the order and times the cosine, u.
  std::optional<BeamEdge> (*edge)(float order) = nullptr;
  double (*beam_edge_rounding_u)(float order, const LawRounding &) = nullptr;
  std::optional<LawSeries> (*series)(const Pattern &) = nullptr;
};

const RadiationLaw &law_of(const Pattern &pattern);
const RadiationLaw &law_of(const shader::GroupSource &diode);

// The error of a diode's J beside its rounding; infinite where its law claims nothing.
double law_error(const Pattern &pattern, DiagramTables &tables, double radius_over_range);
double precise_law_error(const Pattern &pattern); // in fp64

// J's largest value, at least 1, which it has on the axis.
double largest_radiation(const Pattern &pattern);

// A diode's beam edge, and the series by which the reduction expands its J; nothing where its law has none.
std::optional<BeamEdge> beam_edge(const shader::GroupSource &diode);
std::optional<LawSeries> law_series(const Pattern &pattern);

// The cheapest form that knows the laws of all diodes.
LawForm form_of(const std::vector<CameraIlluminator> &illuminators);

// The largest slope of ln J of any diode, as in RadiationLaw.
double pattern_slope(const std::vector<CameraIlluminator> &illuminators,
                     const std::vector<VisibleBox> &visible);

// The largest rounding of J of any diode, u, and that at the rims of beams, as in RadiationLaw; 0 for laws
// that claim none.
double law_rounding_u(std::span<const shader::GroupSource> diodes, const LawRounding &sum);
double beam_edge_rounding_u(std::span<const shader::GroupSource> diodes, const LawRounding &sum);
// An error of narrow beams that none of any diode exceeds, u; nothing for laws that have none apart.
BeamError beam_rounding(std::span<const shader::GroupSource> diodes, const LawRounding &sum);

} // namespace pmdsim
