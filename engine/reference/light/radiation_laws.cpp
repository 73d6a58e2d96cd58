#include "engine/reference/light/radiation_laws.h"

#include "engine/reference/light/diagram.h"
#include "engine/reference/reference.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace pmdsim::reference {

namespace {

using Kind = Pattern::Kind;

struct RadiationLaw {
  Kind kind;
  double (*radiation)(const Diode &diode, const glm::dvec3 &to_diode_m, double range_m);
  double (*solid_angle_sr)(const Pattern &pattern);
};

double cosine(const Diode &diode, const glm::dvec3 &to_diode_m, double range_m) {
  const double cos_theta = -glm::dot(diode.axis, to_diode_m) / range_m;
  return cos_theta > 0 ? std::pow(cos_theta, diode.pattern.order) : 0.0;
}

constexpr std::array laws{
    RadiationLaw{Kind::isotropic, [](const Diode &, const glm::dvec3 &, double) { return 1.0; },
                 [](const Pattern &) { return 2.0 * full_turn_rad; }},
    RadiationLaw{Kind::cosine, cosine,
                 [](const Pattern &pattern) { return full_turn_rad / (pattern.order + 1.0); }},
    RadiationLaw{Kind::diagram,
                 [](const Diode &diode, const glm::dvec3 &to_diode_m, double) {
                   return diagram_gain(diode, -to_diode_m);
                 },
                 [](const Pattern &pattern) { return diagram_solid_angle_sr(*pattern.diagram); }},
};

constexpr bool are_in_order() {
  for (std::size_t i = 0; i < laws.size(); ++i)
    if (laws[i].kind != static_cast<Kind>(i))
      return false;
  return laws.size() == law_names.size();
}
static_assert(are_in_order(), "laws[kind] is the law of that kind");

const RadiationLaw &law_of(const Pattern &pattern) { return laws[static_cast<std::size_t>(pattern.kind)]; }

} // namespace

double radiation(const Diode &diode, const glm::dvec3 &to_diode_m, double range_m) {
  return law_of(diode.pattern).radiation(diode, to_diode_m, range_m);
}

double solid_angle_sr(const Pattern &pattern) { return law_of(pattern).solid_angle_sr(pattern); }

} // namespace pmdsim::reference
