#include "host/bench/native/native_kernel.h"

#include "engine/model/instruction_sets.h"
#include "engine/model/sensor.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <thread>

namespace pmdsim {

// One for each of host/CMakeLists.txt's instruction sets.
namespace baseline {
extern const NativeSums sums;
}
#ifdef __x86_64__
namespace avx2 {
extern const NativeSums sums;
}
namespace avx512 {
extern const NativeSums sums;
}
#endif

namespace {

constexpr std::size_t checked_points = 1000;

// The mean of the diodes by intensity.
glm::dvec3 middle_m(const std::vector<NativeWork::Source> &diodes) {
  glm::dvec3 sum(0.0);
  double intensity = 0.0;
  for (const NativeWork::Source &diode : diodes) {
    sum += diode.intensity_w_sr * diode.position_m;
    intensity += diode.intensity_w_sr;
  }
  return sum / intensity;
}

std::vector<NativeTile> tiles_of(const std::vector<glm::dvec3> &points_m, const glm::dvec3 &middle_m) {
  std::vector<NativeTile> tiles((points_m.size() + native_tile_points - 1) / native_tile_points);
  for (std::size_t i = 0; i < tiles.size() * native_tile_points; ++i) {
    const glm::vec3 point(points_m[std::min(i, points_m.size() - 1)] - middle_m);
    NativeTile &tile = tiles[i / native_tile_points];
    const std::size_t k = i % native_tile_points;
    tile.x_m[k] = point.x, tile.y_m[k] = point.y, tile.z_m[k] = point.z;
    tile.range_m[k] = static_cast<float>(glm::length(glm::dvec3(point)));
  }
  return tiles;
}

std::vector<NativeDiode> native_diodes(const std::vector<NativeWork::Source> &sources,
                                       const glm::dvec3 &middle_m) {
  std::vector<NativeDiode> diodes;
  for (const NativeWork::Source &source : sources) {
    const glm::vec3 place(source.position_m - middle_m);
    const glm::dvec3 exact(place);
    diodes.push_back({place.x, place.y, place.z, static_cast<float>(source.intensity_w_sr),
                      static_cast<float>(glm::dot(exact, exact))});
  }
  return diodes;
}

} // namespace

unsigned native_threads() {
  // The program never changes its environment.
  const char *text = std::getenv("LP_NUM_THREADS"); // NOLINT(concurrency-mt-unsafe)
  unsigned threads = 0;
  if (text && std::from_chars(text, text + std::strlen(text), threads).ec == std::errc())
    return std::max(threads, 1u);
  return std::max(std::thread::hardware_concurrency(), 1u);
}

std::vector<const NativeSums *> available_native_sums() {
  std::vector<const NativeSums *> available;
#ifdef __x86_64__
  if (has_avx512())
    available.push_back(&avx512::sums);
  if (has_avx2())
    available.push_back(&avx2::sums);
#endif
  available.push_back(&baseline::sums);
  return available;
}

NativeKernel::NativeKernel(const NativeWork &work, const NativeSums &sums, unsigned threads)
    : sums_(&sums), threads_(threads),
      wavenumber_per_m_(2.0 * std::numbers::pi * work.modulation_hz / speed_of_light_m_s),
      tiles_(tiles_of(work.points_m, middle_m(work.diodes))),
      diodes_(native_diodes(work.diodes, middle_m(work.diodes))), points_(work.points_m.size()),
      phases_rad_(tiles_.size() * native_tile_points) {}

double NativeKernel::interactions() const {
  return static_cast<double>(points_) * static_cast<double>(diodes_.size());
}

void NativeKernel::sum_tiles(NativeSum sum, std::size_t first, std::size_t end) {
  sum(tiles_.data() + first, end - first, diodes_.data(), diodes_.size(),
      static_cast<float>(wavenumber_per_m_), phases_rad_.data() + first * native_tile_points);
}

double NativeKernel::run_s(NativeSum sum) {
  const auto start = std::chrono::steady_clock::now();
  {
    std::vector<std::jthread> others;
    const auto share = [&](std::size_t i) { return tiles_.size() * i / threads_; };
    for (unsigned i = 1; i < threads_; ++i)
      others.emplace_back([&, i] { sum_tiles(sum, share(i), share(i + 1)); });
    sum_tiles(sum, 0, share(1));
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double NativeKernel::true_phase_rad(std::size_t point) const {
  const NativeTile &tile = tiles_[point / native_tile_points];
  const std::size_t k = point % native_tile_points;
  const glm::dvec3 place_m(glm::vec3(tile.x_m[k], tile.y_m[k], tile.z_m[k]));
  const double range_m = glm::length(place_m);
  std::complex<double> z = 0.0;
  for (const NativeDiode &diode : diodes_) {
    const double r_m = glm::length(place_m - glm::dvec3(glm::vec3(diode.x_m, diode.y_m, diode.z_m)));
    z += std::polar(static_cast<double>(diode.intensity_w_sr) / (r_m * r_m),
                    wavenumber_per_m_ * (r_m - range_m));
  }
  return std::arg(z);
}

double NativeKernel::error_max_m() const {
  double largest_rad = 0.0;
  const std::size_t step = std::max(points_ / checked_points, std::size_t{1});
  for (std::size_t i = 0; i < points_; i += step) {
    const double error_rad = std::abs(
        std::remainder(static_cast<double>(phases_rad_[i]) - true_phase_rad(i), 2.0 * std::numbers::pi));
    if (!(error_rad <= largest_rad)) // NaN is one
      largest_rad = error_rad;
  }
  return largest_rad / (2.0 * wavenumber_per_m_);
}

} // namespace pmdsim
