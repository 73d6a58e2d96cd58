#pragma once
// From radiance in front of the lens to electrons in the pixel, step by step, in double (docs/theory.md,
// "Electrons").

#include "engine/model/sensor.h"

namespace pmdsim {

inline constexpr double planck_j_s = 6.62607015e-34; // exactly

// pi L T / (4 N^2) on the chip, W/m^2. A vignetting of the lens is in the radiance already.
double irradiance_w_m2(double radiance_w_m2_sr, const Electronics &electronics);
// On the pixel's active area, or that of one of the parts that are averaged, in one image's exposure.
double photons(double irradiance_w_m2, const Sensor &sensor);
// In both taps together.
double electrons(double photons, const Electronics &electronics);

// All three of a sensor with electronics.
double electrons_of(double radiance_w_m2_sr, const Sensor &sensor);

// The electrons of an image in both taps: of the light's mean, of foreign light, and in the dark.
struct ImageElectrons {
  double signal_e, background_e, dark_e;

  double sum_e() const { return signal_e + background_e + dark_e; }
};

// The mean electrons of taps A and B of an image, (S + B + D) / 2 +- C s / 2, s the electrons of the
// noiseless correlation sample. One tap: A alone.
struct TapElectrons {
  double a_e, b_e;
};
TapElectrons tap_electrons(const ImageElectrons &image, double correlation_e, double contrast);

// What the ADC's steps add to the variance of a tap, and what reading it adds in all, with the read noise,
// e^2.
double step_variance_e2(const Electronics &electronics);
double reading_variance_e2(const Electronics &electronics);

// The standard deviation of the phase that is formed of N images of a sine, rad, to the first order in the
// noise (docs/theory.md, E6), `modulated_e` the electrons of the modulated light. Readings that are averaged
// count; `phase_rad` counts with one tap alone.
double phase_noise_rad(const ImageElectrons &image, double modulated_e, double phase_rad,
                       const Sensor &sensor);

} // namespace pmdsim
