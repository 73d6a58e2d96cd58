// The electrons of a frame: docs/theory.md, "Electrons", in double, pixel by pixel.

#include "engine/reference/electronics/philox.h"
#include "engine/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace pmdsim::reference {
namespace {

constexpr double turn_rad = 2.0 * std::numbers::pi;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double planck_constant_j_s = 6.62607015e-34;
constexpr double counted_below = 64.0, merged_from_e = 1.0;
constexpr double whole_below = 4194304.0;

// The streams of a pixel's random numbers.
enum class Stream : std::uint32_t { normals, counts, reads, pattern };

// Random numbers of one pixel, frequency and exposure.
class PixelChance {
public:
  PixelChance(std::uint64_t seed, const ExposureNumber &number, std::uint32_t frequency, std::uint32_t pixel,
              std::uint32_t exposure, std::uint32_t parts)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}, frame_(number.frame),
        sensor_(number.sensor), frequency_(frequency), pixel_(pixel), exposure_(exposure),
        part_(exposure % parts) {}

  // A word makes two draws: its upper 20 bits the radius, the next one and the last the signs, and those
  // between the angle within a quarter of a turn.
  double normal(Stream stream, std::uint32_t draw) const {
    const std::uint32_t bits = word(stream, draw / 2), of_angle = bits >> 1 & 1023u;
    const double share = (static_cast<double>(bits >> 12) + 0.5) / 1048576.0;
    const double angle_rad = (of_angle + 0.5) / 1024.0 * turn_rad / 4.0;
    const double radius = std::sqrt(-2.0 * std::log(share));
    return draw % 2 == 0 ? std::copysign(radius * std::cos(angle_rad), bits >> 11 & 1u ? -1.0 : 1.0)
                         : std::copysign(radius * std::sin(angle_rad), bits & 1u ? -1.0 : 1.0);
  }

  // By inversion.
  double poisson(double mean, std::uint32_t draw) const {
    const double share = (static_cast<double>(word(Stream::counts, draw)) + 0.5) / 4294967296.0;
    double chance = std::exp(-mean), sum = chance;
    int count = 0;
    while (share > sum && count < 255) {
      ++count;
      chance *= mean / count;
      sum += chance;
    }
    return count;
  }

private:
  std::uint32_t word(Stream stream, std::uint32_t number) const {
    const bool fixed = stream == Stream::pattern;
    const PhiloxCounter counter{pixel_, fixed ? 0 : frame_,
                                (fixed ? 0 : frequency_ << 16) | static_cast<std::uint32_t>(stream) << 8 |
                                    number / 4,
                                sensor_ << 16 | (fixed ? part_ : exposure_)};
    return philox4x32(counter, key_)[number % 4];
  }

  PhiloxKey key_;
  std::uint32_t frame_, sensor_, frequency_, pixel_, exposure_, part_;
};

// One pixel's images at one frequency.
struct PixelTaps {
  std::vector<double> charge_e[2], number_dn[2];
  std::uint32_t saturated = 0;
};

class PixelCamera {
public:
  PixelCamera(const Frame &frame, const Sensor &sensor, const ExposureNumber &number, std::uint32_t frequency)
      : frame_(frame), of_(*sensor.electronics), sensor_(sensor), number_(number), frequency_(frequency) {
    const double energy_j = planck_constant_j_s * speed_of_light_m_s / of_.wavelength_m;
    const double area_m2 =
        sensor.pixel_pitch_m.x * sensor.fill_factor.x * sensor.pixel_pitch_m.y * sensor.fill_factor.y;
    const double irradiance =
        std::numbers::pi * of_.lens_transmission / (4.0 * of_.lens_f_number * of_.lens_f_number);
    electrons_per_radiance_ = irradiance * area_m2 / of_.parts_averaged * of_.integration_time_s / energy_j *
                              of_.quantum_efficiency;
  }

  // Readings that are averaged.
  double exposures() const { return static_cast<double>(of_.frames_averaged) * of_.parts_averaged; }
  double contrast() const { return of_.contrast(frequency_); }
  double electrons_per_radiance() const { return electrons_per_radiance_; }

  // The mean of a tap without its fixed pattern; of light alone, or with the dark current.
  double light_e(std::uint32_t image, std::size_t pixel, int tap) const {
    double background = of_.background_radiance_w_m2_sr;
    if (!of_.background_image.empty())
      background *= static_cast<double>(of_.background_image[pixel]);
    const double common = frame_.mean_radiance[pixel] + background;
    const double part = contrast() * frame_.returns[frequency_].taps[image][pixel];
    return std::max(0.0, 0.5 * electrons_per_radiance_ * (tap == 0 ? common + part : common - part));
  }
  double dark_e() const { return 0.5 * of_.dark_current_e_per_s * of_.integration_time_s; }

  PixelTaps expose(std::uint32_t pixel) const {
    PixelTaps sum;
    for (int tap = 0; tap < 2; ++tap) {
      sum.charge_e[tap].resize(sensor_.taps);
      sum.number_dn[tap].resize(sensor_.taps);
    }
    for (std::uint32_t exposure = 0; exposure < of_.frames_averaged * of_.parts_averaged; ++exposure)
      for (std::uint32_t image = 0; image < sensor_.taps; ++image)
        add_image(pixel, exposure, image, sum);
    return sum;
  }

private:
  void add_image(std::uint32_t pixel, std::uint32_t exposure, std::uint32_t image, PixelTaps &sum) const {
    const PixelChance chance(of_.seed, number_, frequency_, pixel, exposure, of_.parts_averaged);
    const int taps = of_.two_tap ? 2 : 1;
    double charge[2] = {0.0, 0.0};
    for (int tap = 0; tap < taps; ++tap) {
      const auto t = static_cast<std::uint32_t>(tap);
      const double response = std::max(0.0, 1.0 + of_.prnu * chance.normal(Stream::pattern, t));
      const double mean = response * light_e(image, pixel, tap) + dark_e();
      charge[tap] = charge_e(chance, of_.two_tap ? 2 * image + t : image, mean) +
                    of_.dsnu_e * chance.normal(Stream::pattern, 2 + t);
    }
    if (of_.two_tap) {
      const double over = std::max(charge[0], charge[1]) - of_.full_well_e;
      const double common = std::max(0.0, std::min(charge[0], charge[1]));
      const double taken = std::clamp(over, 0.0, std::min(of_.sbi_e, common));
      charge[0] -= taken;
      charge[1] -= taken;
    }
    for (int tap = 0; tap < taps; ++tap) {
      const bool is_full = charge[tap] > of_.full_well_e;
      charge[tap] = std::min(charge[tap], of_.full_well_e);
      const double voltage_dn = of_.gain_dn_per_e * charge[tap] + of_.offset_dn;
      if (is_full || voltage_dn > of_.largest_dn() + 0.5)
        sum.saturated |= 1u << (static_cast<std::uint32_t>(16 * tap) + image);
      sum.charge_e[tap][image] += charge[tap] / exposures();
      sum.number_dn[tap][image] +=
          std::nearbyint(std::clamp(voltage_dn, 0.0, of_.largest_dn())) / exposures();
    }
  }

  double charge_e(const PixelChance &chance, std::uint32_t draw, double mean) const {
    const double z = chance.normal(Stream::normals, draw);
    if (mean < counted_below)
      return chance.poisson(mean, draw) + of_.read_noise_e * z;
    if (of_.read_noise_e >= merged_from_e)
      return expanded(mean, of_.read_noise_e, z);
    const double count = expanded(mean, 0.0, z);
    const double whole = count < whole_below ? std::max(0.0, std::nearbyint(count)) : count;
    return whole + of_.read_noise_e * (of_.read_noise_e > 0.0 ? chance.normal(Stream::reads, draw) : 0.0);
  }

  // Cornish and Fisher's expansion by the cumulants mean, mean + noise^2, mean, mean.
  static double expanded(double mean, double noise_e, double z) {
    const double deviation = std::sqrt(mean + noise_e * noise_e);
    const double skewness = mean / std::pow(deviation, 3), excess = mean / std::pow(deviation, 4);
    return mean + deviation * (z + skewness / 6.0 * (z * z - 1.0) + excess / 24.0 * (z * z * z - 3.0 * z) -
                               skewness * skewness / 36.0 * (2.0 * z * z * z - 5.0 * z));
  }

  const Frame &frame_;
  const Electronics &of_;
  const Sensor &sensor_;
  ExposureNumber number_;
  std::uint32_t frequency_;
  double electrons_per_radiance_;
};

// The noisy channels of one frequency.
class FrequencyCamera {
public:
  FrequencyCamera(const PixelCamera &camera, const Frame &frame, const Sensor &sensor,
                  std::uint32_t frequency, bool keep_taps, Return &to)
      : camera_(camera), of_(*sensor.electronics), noiseless_(frame.returns[frequency]), taps_(sensor.taps),
        keep_taps_(keep_taps), to_(to) {
    const std::size_t pixels = sensor.pixel_count();
    if (of_.noiseless_channels) {
      to_.amplitude_noiseless = to_.amplitude;
      to_.phase_rad_noiseless = to_.phase_rad;
      to_.distance_m_noiseless = to_.distance_m;
      to_.unrounded_distance_m_noiseless = to_.unrounded_distance_m;
    }
    to_.saturated.resize(pixels);
    to_.distance_noise_m.resize(pixels);
    to_.confidence.resize(pixels);
    const std::vector channel(taps_, std::vector<float>(pixels)), none = std::vector<std::vector<float>>();
    to_.taps = to_.tap_a_e = to_.tap_a_dn = keep_taps ? channel : none;
    to_.tap_b_e = to_.tap_b_dn = keep_taps && of_.two_tap ? channel : none;
  }

  void set(std::uint32_t pixel) {
    const PixelTaps read = camera_.expose(pixel);
    std::vector<double> differences_e;
    double mean_e = 0.0, largest_e = 0.0;
    std::complex<double> z_e = 0.0;
    for (std::uint32_t k = 0; k < taps_; ++k) {
      const double other_dn = of_.two_tap ? read.number_dn[1][k] : of_.offset_dn;
      differences_e.push_back((read.number_dn[0][k] - other_dn) / of_.gain_dn_per_e);
      mean_e += differences_e.back() / taps_;
      largest_e = std::max(largest_e, std::abs(differences_e.back()));
      z_e += 2.0 / taps_ * differences_e.back() * std::polar(1.0, turn_rad * k / taps_);
    }
    constexpr double rounding = 0x1p-20; // what is less is no return
    if (std::max(std::abs(z_e.real()), std::abs(z_e.imag())) <= rounding * largest_e)
      z_e = 0.0;
    const double radiance_per_e =
        (of_.two_tap ? 1.0 : 2.0) / (camera_.contrast() * camera_.electrons_per_radiance());
    set_return(pixel, z_e, radiance_per_e);
    set_noise(pixel, z_e, radiance_per_e);
    to_.saturated[pixel] = read.saturated;
    for (std::uint32_t k = 0; k < taps_ && keep_taps_; ++k) {
      to_.taps[k][pixel] =
          static_cast<float>(radiance_per_e * (differences_e[k] - (of_.two_tap ? 0.0 : mean_e)));
      to_.tap_a_e[k][pixel] = static_cast<float>(read.charge_e[0][k]);
      to_.tap_a_dn[k][pixel] = static_cast<float>(read.number_dn[0][k]);
      if (!of_.two_tap)
        continue;
      to_.tap_b_e[k][pixel] = static_cast<float>(read.charge_e[1][k]);
      to_.tap_b_dn[k][pixel] = static_cast<float>(read.number_dn[1][k]);
    }
  }

private:
  void set_return(std::uint32_t pixel, const std::complex<double> &z_e, double radiance_per_e) {
    const double angle_rad = std::arg(z_e), phase_rad = angle_rad < 0.0 ? angle_rad + turn_rad : angle_rad;
    const bool is_known = z_e != 0.0;
    to_.amplitude[pixel] = static_cast<float>(radiance_per_e * std::abs(z_e));
    to_.phase_rad[pixel] = static_cast<float>(is_known ? phase_rad : no_number);
    const double distance_m = is_known ? noiseless_.ambiguity_m * phase_rad / turn_rad : no_number;
    to_.distance_m[pixel] = static_cast<float>(distance_m);
    if (!to_.unrounded_distance_m.empty())
      to_.unrounded_distance_m[pixel] = distance_m;
  }

  void set_noise(std::uint32_t pixel, const std::complex<double> &z_e, double radiance_per_e) {
    const double step_e = 1.0 / of_.gain_dn_per_e;
    const double reading = of_.read_noise_e * of_.read_noise_e + step_e * step_e / 12.0;
    const double phase_rad = std::arg(noiseless_.z[pixel]);
    double all = 0.0, across = 0.0;
    bool is_full = false;
    for (std::uint32_t k = 0; k < taps_; ++k) {
      const double a = camera_.light_e(k, pixel, 0) + camera_.dark_e();
      const double b = of_.two_tap ? camera_.light_e(k, pixel, 1) + camera_.dark_e() : 0.0;
      const double over = std::max(std::max(a, b) - of_.full_well_e, 0.0);
      const double fullest =
          std::max(a, b) - (of_.two_tap ? std::min(over, std::min(of_.sbi_e, std::min(a, b))) : 0.0);
      is_full = is_full || fullest > of_.full_well_e ||
                of_.gain_dn_per_e * fullest + of_.offset_dn > of_.largest_dn();
      const double variance = a + b + (of_.two_tap ? 2.0 : 1.0) * reading;
      const double sine = std::sin(phase_rad - turn_rad * k / taps_);
      all += variance;
      across += variance * sine * sine;
    }
    const double amplitude_e = std::abs(noiseless_.z[pixel]) / radiance_per_e;
    const double noise_rad = 2.0 / (taps_ * amplitude_e) * std::sqrt(across / camera_.exposures());
    const bool is_known = amplitude_e > 0.0 && !is_full;
    to_.distance_noise_m[pixel] =
        static_cast<float>(is_known ? noiseless_.ambiguity_m * noise_rad / turn_rad : no_number);
    to_.confidence[pixel] =
        static_cast<float>(std::abs(z_e) / (2.0 / taps_ * std::sqrt(0.5 * all / camera_.exposures())));
  }

  const PixelCamera &camera_;
  const Electronics &of_;
  const FrameReturn &noiseless_;
  std::uint32_t taps_;
  bool keep_taps_;
  Return &to_;
};

} // namespace

void count_electrons(const Frame &frame, const Sensor &sensor, bool keep_taps, Measurement &measurement,
                     const std::function<void()> &between) {
  for (std::uint32_t i = 0; i < frame.returns.size(); ++i) {
    const PixelCamera camera(frame, sensor, measurement.number, i);
    FrequencyCamera channels(camera, frame, sensor, i, keep_taps, measurement.returns[i]);
    for (std::uint32_t pixel = 0; pixel < sensor.pixel_count(); ++pixel) {
      if (between && pixel % 64 == 0)
        between();
      channels.set(pixel);
    }
  }
  measurement.has_electrons = true;
}

} // namespace pmdsim::reference
