#include "engine/electronics/scatter.h"

#include "engine/model/stopwatch.h"
#include "engine/model/tap_sequence.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <fftw3.h>
#include <iterator>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <numbers>
#include <type_traits>
#include <utility>
#include <vector>

namespace pmdsim {
namespace {

using Complex = std::complex<float>;

struct Free {
  void operator()(void *memory) const { fftwf_free(memory); }
};
struct Destroy {
  void operator()(fftwf_plan plan) const { fftwf_destroy_plan(plan); }
};
using Plan = std::unique_ptr<std::remove_pointer_t<fftwf_plan>, Destroy>;

// FFTW makes plans by one thread at a time; only running them is safe.
std::mutex &planning() {
  static std::mutex mutex;
  return mutex;
}

// A size without large prime factors, at least `size`.
int fast_size(std::uint32_t size) {
  for (std::uint32_t n = size;; ++n) {
    std::uint32_t rest = n;
    for (const std::uint32_t factor : {2u, 3u, 5u, 7u})
      while (rest % factor == 0)
        rest /= factor;
    if (rest == 1)
      return static_cast<int>(n);
  }
}

// A plane of complex numbers with room around the image for what leaves it.
class Plane {
public:
  explicit Plane(const glm::uvec2 &resolution)
      : columns_(fast_size(2 * resolution.x)), rows_(fast_size(2 * resolution.y)),
        values_(static_cast<Complex *>(fftwf_malloc(sizeof(Complex) * count()))) {
    if (!values_)
      throw std::bad_alloc();
    const std::scoped_lock alone(planning());
    auto *const memory = reinterpret_cast<fftwf_complex *>(values_.get());
    // An estimated plan does not depend on measured times, so that every run has the same bits.
    forward_.reset(fftwf_plan_dft_2d(rows_, columns_, memory, memory, FFTW_FORWARD, FFTW_ESTIMATE));
    backward_.reset(fftwf_plan_dft_2d(rows_, columns_, memory, memory, FFTW_BACKWARD, FFTW_ESTIMATE));
    if (!forward_ || !backward_)
      throw std::bad_alloc();
  }
  ~Plane() {
    const std::scoped_lock alone(planning());
    forward_.reset();
    backward_.reset();
  }
  Plane(const Plane &) = delete;
  Plane &operator=(const Plane &) = delete;

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  std::size_t count() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }
  Complex *values() { return values_.get(); }
  Complex &at(std::size_t column, std::size_t row) {
    return values_.get()[row * static_cast<std::size_t>(columns_) + column];
  }
  void transform() { fftwf_execute(forward_.get()); }
  void transform_back() { fftwf_execute(backward_.get()); }

private:
  int columns_, rows_;
  std::unique_ptr<Complex, Free> values_;
  Plan forward_, backward_;
};

// The part of a Gaussian's light that falls on pixels so many away along one axis, 0 ... count - 1.
std::vector<double> parts_of_gaussian(double sigma_m, double pitch_m, std::uint32_t count) {
  const double per_sigma = pitch_m / (std::numbers::sqrt2 * sigma_m);
  std::vector<double> parts;
  for (std::uint32_t i = 0; i < count; ++i)
    parts.push_back(0.5 * (std::erf((i + 0.5) * per_sigma) - std::erf((i - 0.5) * per_sigma)));
  return parts;
}

class Scattering {
public:
  explicit Scattering(const Sensor &sensor) : resolution_(sensor.resolution), plane_(sensor.resolution) {
    std::fill_n(plane_.values(), plane_.count(), Complex());
    double direct = 1.0;
    for (const ScatterLobe &lobe : sensor.scatter) {
      direct -= lobe.share;
      add_lobe(lobe, sensor.pixel_pitch_m);
    }
    response_.reserve(plane_.count());
    plane_.at(0, 0) += static_cast<float>(direct);
    plane_.transform();
    const auto scale = 1.0f / static_cast<float>(plane_.count());
    // The lobes are even in both axes, so that their transform is real.
    std::transform(plane_.values(), plane_.values() + plane_.count(), std::back_inserter(response_),
                   [scale](const Complex &value) { return scale * value.real(); });
  }

  // Replaces an image, given and taken pixel by pixel.
  template <class Get, class Set>
  void apply(const Get &get, const Set &set) {
    std::fill_n(plane_.values(), plane_.count(), Complex());
    for_each_pixel([&](std::size_t pixel, Complex &value) { value = get(pixel); });
    plane_.transform();
    for (std::size_t i = 0; i < plane_.count(); ++i)
      plane_.values()[i] *= response_[i];
    plane_.transform_back();
    for_each_pixel([&](std::size_t pixel, const Complex &value) { set(pixel, value); });
  }

private:
  // To either side, where the plane's end stands for what lies before its beginning.
  void add_lobe(const ScatterLobe &lobe, const glm::dvec2 &pitch_m) {
    const std::vector<double> across = parts_of_gaussian(lobe.sigma_m, pitch_m.x, resolution_.x),
                              down = parts_of_gaussian(lobe.sigma_m, pitch_m.y, resolution_.y);
    const auto either_side = [](std::size_t i, int size) {
      return std::pair(i, i == 0 ? i : static_cast<std::size_t>(size) - i);
    };
    for (std::size_t y = 0; y < down.size(); ++y)
      for (std::size_t x = 0; x < across.size(); ++x) {
        const auto part = static_cast<float>(lobe.share * across[x] * down[y]);
        const auto [right, left] = either_side(x, plane_.columns());
        const auto [below, above] = either_side(y, plane_.rows());
        plane_.at(right, below) += part;
        if (x > 0)
          plane_.at(left, below) += part;
        if (y > 0)
          plane_.at(right, above) += part;
        if (x > 0 && y > 0)
          plane_.at(left, above) += part;
      }
  }

  template <class Visit>
  void for_each_pixel(const Visit &visit) {
    for (std::size_t row = 0; row < resolution_.y; ++row)
      for (std::size_t column = 0; column < resolution_.x; ++column)
        visit(row * resolution_.x + column, plane_.at(column, row));
  }

  glm::uvec2 resolution_;
  Plane plane_;
  std::vector<float> response_; // of the plane's frequencies, over their number
};

// Two at a time: the response is real, so that real and imaginary parts know nothing of each other.
void scatter_pair(Scattering &scattering, std::vector<float> &first, std::vector<float> *second) {
  scattering.apply([&](std::size_t pixel) { return Complex(first[pixel], second ? (*second)[pixel] : 0.0f); },
                   [&](std::size_t pixel, const Complex &value) {
                     first[pixel] = value.real();
                     if (second)
                       (*second)[pixel] = value.imag();
                   });
}

void scatter_all(Scattering &scattering, std::vector<std::vector<float>> &images) {
  std::vector<std::vector<float> *> filled;
  for (std::vector<float> &image : images)
    if (!image.empty())
      filled.push_back(&image);
  for (std::size_t i = 0; i < filled.size(); i += 2)
    scatter_pair(scattering, *filled[i], i + 1 < filled.size() ? filled[i + 1] : nullptr);
}

// Light does not fall below 0, as rounding may.
void scatter_mean(Scattering &scattering, std::vector<float> &radiance) {
  if (radiance.empty())
    return;
  scatter_pair(scattering, radiance, nullptr);
  for (float &value : radiance)
    value = std::max(value, 0.0f);
}

// What is less than that part of the brightest pixel is the transforms' rounding.
constexpr float rounding_part = 1e-6f;

void scatter_return(Scattering &scattering, double ambiguity_m, Return &of) {
  const float least = of.amplitude.empty() ? 0.0f : rounding_part * std::ranges::max(of.amplitude);
  scattering.apply(
      [&](std::size_t pixel) {
        return of.amplitude[pixel] > 0.0f ? std::polar(of.amplitude[pixel], of.phase_rad[pixel]) : Complex();
      },
      [&](std::size_t pixel, const Complex &value) {
        if (std::abs(value) > least)
          return set_return(of, pixel, value, ambiguity_m);
        of.amplitude[pixel] = 0.0f;
        of.phase_rad[pixel] = of.distance_m[pixel] = std::numeric_limits<float>::quiet_NaN();
        if (!of.unrounded_distance_m.empty())
          of.unrounded_distance_m[pixel] = std::numeric_limits<double>::quiet_NaN();
      });
}

} // namespace

void scatter(const Sensor &sensor, Measurement &frame) {
  Stopwatch stopwatch;
  Scattering scattering(sensor);
  scatter_mean(scattering, frame.mean_radiance);
  for (std::size_t i = 0; i < frame.returns.size(); ++i) {
    Return &of = frame.returns[i];
    scatter_return(scattering, sensor.ambiguity_m(i), of);
    scatter_all(scattering, of.taps);
  }
  stopwatch.add_to(frame, "scatter");
}

void scatter_taps(const Sensor &sensor, std::vector<std::vector<float>> &mean_radiance, Measurement &frame) {
  Stopwatch stopwatch;
  Scattering scattering(sensor);
  for (std::vector<float> &of_tap : mean_radiance)
    scatter_mean(scattering, of_tap);
  if (!mean_radiance.empty())
    frame.mean_radiance = mean_radiance.front();
  for (std::size_t i = 0; i < frame.returns.size(); ++i) {
    Return &of = frame.returns[i];
    scatter_all(scattering, of.taps);
    set_from_taps(of, std::move(of.taps), sensor.modulation_hz[i]);
  }
  stopwatch.add_to(frame, "scatter");
}

} // namespace pmdsim
