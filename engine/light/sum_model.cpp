#include "engine/light/sum_model.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

// Up to here a whole power is multiplied out; the general form is as exact and faster beyond.
constexpr double largest_whole_power = 8.0;

template <typename Property>
bool every_pattern(const std::vector<CameraIlluminator> &illuminators, const Property &holds) {
  return std::ranges::all_of(illuminators, [&](const CameraIlluminator &illuminator) {
    return std::ranges::all_of(illuminator.diodes, holds, &Diode::pattern);
  });
}

// The plainest of shader::pattern_* that holds all patterns.
std::uint32_t pattern_of(const std::vector<CameraIlluminator> &illuminators) {
  const auto every = [&](const auto &holds) { return every_pattern(illuminators, holds); };
  const Pattern &first = illuminators.front().diodes.front().pattern;
  if (every([](const Pattern &pattern) { return pattern.kind == Pattern::Kind::isotropic; }))
    return shader::pattern_isotropic;
  if (first.order >= 1.0 && first.order <= largest_whole_power && first.order == std::floor(first.order) &&
      every([&](const Pattern &pattern) {
        return pattern.kind == Pattern::Kind::cosine && pattern.order == first.order;
      }))
    return shader::pattern_power;
  if (every([](const Pattern &pattern) { return pattern.kind != Pattern::Kind::diagram; }))
    return shader::pattern_general;
  if (every([](const Pattern &pattern) {
        return pattern.kind == Pattern::Kind::diagram && pattern.diagram->phi_rad.size() == 1;
      }))
    return shader::pattern_axial;
  return shader::pattern_any;
}

} // namespace

SumModel sum_model(const std::vector<CameraIlluminator> &illuminators, Backscatter backscatter,
                   bool all_face_the_light) {
  SumModel model{shader::backscatter_lambert, pattern_of(illuminators), 0};
  if (backscatter == Backscatter::constant)
    model.backscatter = all_face_the_light ? shader::backscatter_flat : shader::backscatter_facing;
  if (model.pattern == shader::pattern_power)
    model.order = static_cast<std::uint32_t>(illuminators.front().diodes.front().pattern.order);
  return model;
}

std::optional<std::uint32_t> inverse_powers(const SumModel &model) {
  if (model.pattern > shader::pattern_power)
    return std::nullopt;
  return 2 + (model.backscatter == shader::backscatter_lambert ? 1 : 0) + model.order;
}

namespace {

bool are_alike(const DiodeGroups &groups, const SumModel &model) {
  return model.backscatter == shader::backscatter_flat && model.pattern == shader::pattern_isotropic &&
         std::ranges::all_of(groups.diodes, [](const shader::GroupDiode &diode) {
           return diode.intensity == 1.0f || diode.position == glm::vec4(0.0f);
         });
}

// Of a diode that shines, relative to the strongest.
double least_intensity(const DiodeGroups &groups) {
  double least = 1.0;
  for (const shader::GroupDiode &diode : groups.diodes)
    if (diode.intensity > 0.0f)
      least = std::min(least, static_cast<double>(diode.intensity));
  return least;
}

} // namespace

void sum_by_powers(DiodeGroups &groups, const SumModel &model, double wavenumber_rad_m,
                   const PathForms &allowed) {
  std::vector<Excess> reaches;
  for (const DiodeRun &run : groups.runs)
    reaches.push_back(run.reach);
  if (const auto powers = inverse_powers(model); powers && allowed.polynomial_moments)
    groups.power_sums =
        power_sums(reaches, *powers, groups.moments, wavenumber_rad_m, least_intensity(groups));
  if (groups.power_sums.powers == 0)
    return;
  groups.power_sums.alike = allowed.equal_weights && are_alike(groups, model);
  groups.power_sums.planar =
      allowed.coplanar && std::ranges::all_of(groups.diodes, [](const shader::GroupDiode &diode) {
        return diode.position.z == 0.0f;
      });
}

Precision sum_precision(const Signal &signal, Precision wanted) {
  return signal.by_moments ? wanted : Precision::fp32;
}

} // namespace pmdsim
