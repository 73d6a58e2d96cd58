#include "engine/radiosity/direct_irradiance.h"

#include "engine/light/radiation_laws.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace pmdsim {
namespace {

// A diode's way to a place, as far as it is not dark there.
struct Way {
  double weight_w_m2;
  double length_m;
  double phase_turns, modulation_depth;
};

} // namespace

DirectIrradiance::DirectIrradiance(const std::vector<Illuminator> &illuminators, const glm::dvec3 &origin_m,
                                   const FacetTree *tree, double clearance_m)
    : tree_(tree), clearance_m_(clearance_m) {
  for (const Illuminator &illuminator : illuminators)
    for (const Diode &diode : illuminator.diodes) {
      if (diode.intensity_w_sr == 0.0)
        continue;
      if (!law_of(diode.pattern).value)
        throw std::logic_error("a radiation law without a value in double");
      const Pose &pose = illuminator.world_from_illuminator;
      Diode placed = diode;
      placed.position_m = pose.point(diode.position_m) - origin_m;
      placed.axis = pose.direction(diode.axis);
      placed.across = pose.direction(diode.across);
      positions_m_.emplace_back(placed.position_m);
      sources_.push_back({placed, illuminator.modulation_phase_rad / (2.0 * std::numbers::pi),
                          illuminator.modulation_depth});
    }
}

void DirectIrradiance::at(const SurfacePlace &place, std::span<const BounceTone> tones,
                          std::span<Phasor> irradiance) const {
  thread_local std::vector<Way> ways;
  thread_local std::vector<glm::vec3> ends_m;
  thread_local std::vector<std::uint8_t> is_free;
  ways.clear();
  ends_m.clear();
  for (std::size_t m = 0; m < sources_.size(); ++m) {
    const auto &[diode, phase_turns, modulation_depth] = sources_[m];
    const glm::dvec3 way = place.position_m - diode.position_m; // from the diode
    const double facing = -glm::dot(way, place.normal);
    if (facing <= 0.0)
      continue;
    const double range2 = glm::dot(way, way), range_m = std::sqrt(range2);
    const double weight =
        diode.intensity_w_sr * law_of(diode.pattern).value(diode, way) * facing / (range2 * range_m);
    if (weight <= 0.0)
      continue;
    ways.push_back({weight, range_m, phase_turns, modulation_depth});
    ends_m.push_back(positions_m_[m]);
  }
  is_free.assign(ways.size(), 1);
  if (tree_)
    tree_->look(place.position_m + clearance_m_ * place.normal, ends_m, is_free);
  for (std::size_t t = 0; t < tones.size(); ++t) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      if (!is_free[i])
        continue;
      const Phasor phasor =
          unit_phasor(tones[t].turns_per_m() * ways[i].length_m + tones[t].harmonic * ways[i].phase_turns);
      sum += ways[i].weight_w_m2 / (tones[t].is_mean() ? ways[i].modulation_depth : 1.0) *
             std::complex<double>(static_cast<double>(phasor.re), static_cast<double>(phasor.im));
    }
    irradiance[t] = {static_cast<float>(sum.real()), static_cast<float>(sum.imag())};
  }
}

} // namespace pmdsim
