#pragma once
// The sensor's electronics, from the light on the chip to digital numbers, in the terms of EMVA Standard 1288
// (release 4.0, 2021), plain data in SI units. docs/theory.md, "Electrons", has the equations.

#include <cstdint>
#include <vector>

namespace pmdsim {

struct Electronics {
  double integration_time_s = 1e-3; // of the exposure of one image: both taps share it
  double quantum_efficiency = 1.0;  // electrons over photons on the active area, 0 to 1
  double wavelength_m = 850e-9;
  double lens_f_number = 1.0;     // N of pi L T / (4 N^2)
  double lens_transmission = 1.0; // T, filter included
  // Of the pixel: (A - B) over what it would be if each tap took all light of its half period's cosine. One
  // for all frequencies, or one each.
  std::vector<double> demodulation_contrast{1.0};
  double full_well_e = 1e5;          // of a tap
  double read_noise_e = 0.0;         // standard deviation, of a tap
  double dark_current_e_per_s = 0.0; // of the pixel, half of it to each tap
  double dsnu_e = 0.0;               // standard deviation over the taps of all pixels, of an offset
  double prnu = 0.0;                 // the same of the response to light, relative
  double gain_dn_per_e = 1.0;        // K
  std::uint32_t adc_bits = 12;
  double offset_dn = 0.0; // of a dark tap
  // Foreign light in the filter's band, from everywhere; or of each pixel, row by row, times that.
  double background_radiance_w_m2_sr = 0.0;
  std::vector<float> background_image{}; // empty: the same of all
  double sbi_e = 0.0;  // the most that is taken from both taps alike where one would be more than full
  bool two_tap = true; // else tap A alone is read
  std::uint32_t frames_averaged = 1; // digital numbers of so many frames are averaged
  // And of so many parts of a pixel, each of which has its share of the area and figures as above of its own.
  std::uint32_t parts_averaged = 1;
  std::uint64_t seed = 0;
  bool noiseless_channels = false; // the channels of the noiseless camera stand beside the others

  double contrast(std::size_t frequency) const {
    return demodulation_contrast[demodulation_contrast.size() > 1 ? frequency : 0];
  }
  // Digital numbers that are averaged, at most 2^16.
  std::uint32_t readings() const { return frames_averaged * parts_averaged; }
  // The largest digital number.
  double largest_dn() const { return static_cast<double>((std::uint64_t{1} << adc_bits) - 1); }
};

} // namespace pmdsim
