#include "engine/light/sum_model.h"

#include "engine/light/point_polynomials.h"
#include "engine/light/radiation_laws.h"

#include <algorithm>

namespace pmdsim {
SumModel sum_model(const std::vector<CameraIlluminator> &illuminators, Backscatter backscatter,
                   bool all_face_the_light) {
  const LawForm form = form_of(illuminators);
  SumModel model{shader::backscatter_lambert, form.pattern, form.range_powers, all_face_the_light};
  if (backscatter == Backscatter::constant)
    model.backscatter = all_face_the_light ? shader::backscatter_flat : shader::backscatter_facing;
  return model;
}

double inverse_powers(const SumModel &model) {
  return 2 + (model.backscatter == shader::backscatter_lambert ? 1 : 0) + model.order;
}

namespace {

bool have_equal_weights(const SourceGroups &groups, const SumModel &model) {
  return model.backscatter == shader::backscatter_flat && model.pattern == shader::pattern_isotropic &&
         std::ranges::all_of(groups.diodes, [](const shader::GroupSource &diode) {
           return diode.intensity == 1.0f || diode.position == glm::vec4(0.0f);
         });
}

// The least intensity of a diode that shines, relative to the strongest.
double least_intensity(const SourceGroups &groups) {
  double least = 1.0;
  for (const shader::GroupSource &diode : groups.diodes)
    if (diode.intensity > 0.0f)
      least = std::min(least, static_cast<double>(diode.intensity));
  return least;
}

} // namespace

void choose_polynomials(SourceGroups &groups, const SumModel &model, double wavenumber_rad_m,
                        const PathForms &allowed, bool host_sums) {
  std::vector<PathDifference> reaches;
  for (const SourceRun &run : groups.runs)
    reaches.push_back(run.reach);
  const double inverse = inverse_powers(model);
  if (allowed.polynomial_moments && model.pattern != shader::pattern_general)
    groups.polynomials = fit_polynomials(reaches, inverse, groups.moments, wavenumber_rad_m,
                                         least_intensity(groups), groups.tolerance);
  if (groups.polynomials.powers == 0) {
    if (host_sums)
      groups.near_polynomials = bound_near_polynomials(reaches, inverse, groups.moments, wavenumber_rad_m,
                                                       groups.tolerance, groups.near_growth);
    return;
  }
  groups.polynomials.equal_weights = allowed.equal_weights && have_equal_weights(groups, model);
  groups.polynomials.coplanar =
      allowed.coplanar && std::ranges::all_of(groups.diodes, [](const shader::GroupSource &diode) {
        return diode.position.z == 0.0f;
      });
  if (allowed.point_polynomials)
    groups.polynomials.point_dimensions = point_dimensions(groups, model);
}

} // namespace pmdsim
