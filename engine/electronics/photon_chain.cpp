#include "engine/electronics/photon_chain.h"

#include <cmath>
#include <numbers>

namespace pmdsim {

double irradiance_w_m2(double radiance_w_m2_sr, const Electronics &electronics) {
  const double n = electronics.lens_f_number;
  return std::numbers::pi * radiance_w_m2_sr * electronics.lens_transmission / (4.0 * n * n);
}

double photons(double irradiance_w_m2, const Sensor &sensor) {
  const glm::dvec2 active_m = sensor.pixel_pitch_m * sensor.fill_factor;
  const double area_m2 = active_m.x * active_m.y / sensor.electronics->parts_averaged;
  const double energy_j = irradiance_w_m2 * area_m2 * sensor.electronics->integration_time_s;
  return energy_j * sensor.electronics->wavelength_m / (planck_j_s * speed_of_light_m_s);
}

double electrons(double photons, const Electronics &electronics) {
  return electronics.quantum_efficiency * photons;
}

double electrons_of(double radiance_w_m2_sr, const Sensor &sensor) {
  return electrons(photons(irradiance_w_m2(radiance_w_m2_sr, *sensor.electronics), sensor),
                   *sensor.electronics);
}

TapElectrons tap_electrons(const ImageElectrons &image, double correlation_e, double contrast) {
  const double common_e = 0.5 * image.sum_e(), part_e = 0.5 * contrast * correlation_e;
  return {common_e + part_e, common_e - part_e};
}

double step_variance_e2(const Electronics &electronics) {
  const double step_e = 1.0 / electronics.gain_dn_per_e;
  return step_e * step_e / 12.0;
}

double reading_variance_e2(const Electronics &electronics) {
  return electronics.read_noise_e * electronics.read_noise_e + step_variance_e2(electronics);
}

double phase_noise_rad(const ImageElectrons &image, double modulated_e, double phase_rad,
                       const Sensor &sensor) {
  const Electronics &electronics = *sensor.electronics;
  const double contrast = electronics.contrast(0), amplitude_e = contrast * modulated_e;
  const double reading_e2 = reading_variance_e2(electronics);
  double across = 0.0;
  for (std::uint32_t k = 0; k < sensor.taps; ++k) {
    const double apart_rad = phase_rad - 2.0 * std::numbers::pi * k / sensor.taps;
    const TapElectrons taps = tap_electrons(image, modulated_e * std::cos(apart_rad), contrast);
    const double variance =
        electronics.two_tap ? taps.a_e + taps.b_e + 2.0 * reading_e2 : taps.a_e + reading_e2;
    across += variance * std::sin(apart_rad) * std::sin(apart_rad);
  }
  const double of_difference_e = electronics.two_tap ? amplitude_e : 0.5 * amplitude_e;
  return 2.0 / (sensor.taps * of_difference_e) * std::sqrt(across / electronics.readings());
}

} // namespace pmdsim
