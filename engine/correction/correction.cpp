#include "engine/correction/correction.h"

#include "engine/correction/range_noise.h"
#include "engine/correction/range_search.h"
#include "engine/correction/surface_fit.h"
#include "engine/lens/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t most_passes = 8;
// A pass that moves no pixel that is sure by more is the last.
constexpr double settled_m = 2e-8, settled_noises = 1e-2;
// An edge is where an uncertain normal moves the range by so much, and by so many times as much as in half of
// all pixels, or where the normal is so uncertain.
constexpr double least_edge_limit_m = 2e-6, edge_errors = 5.0, edge_rad = 0.1;
// A pixel with fewer neighbours that are no edges is one: among facets of about a pixel planes fit by chance,
// here and there. Where a surface's own corner ends the image, a pixel has so many.
constexpr int least_neighbours = 3;
// By then normals are so near that ranges change with them as they did before.
constexpr std::uint32_t last_pass_of_sensitivity = 2;
constexpr std::uint32_t rows_between_progress = 32;

std::size_t pixels_of(const Sensor &sensor) { return sensor.pixel_count(); }

// What a pixel averages over: the points of a rule for its active area, in pixels from its centre, by which
// quadratics have the mean that they have over its samples. None for a single sample.
std::vector<glm::dvec2> area_points(const Sensor &sensor) {
  if (sensor.samples < 2)
    return {};
  const double squared = 1.0 - 1.0 / (static_cast<double>(sensor.samples) * sensor.samples);
  const glm::dvec2 off = sensor.fill_factor * std::sqrt(squared / 12.0);
  return {{-off.x, -off.y}, {off.x, -off.y}, {-off.x, off.y}, {off.x, off.y}};
}

class Correction {
public:
  Correction(const Sensor &sensor, const std::vector<Illuminator> &illuminators, const MeasuredImage &image,
             const CorrectionOptions &options, const std::function<void(double)> &progress)
      : sensor_(sensor), lens_(sensor), search_(sensor, illuminators, options), image_(image),
        options_(options), progress_(progress), area_points_(area_points(sensor)) {
    if (image.phase_rad.size() != pixels_of(sensor) ||
        (!image.guess_m.empty() && image.guess_m.size() != pixels_of(sensor)))
      throw std::logic_error("an image that is not of the sensor's size");
  }

  CorrectedImage run() {
    find_rays();
    first_pass();
    if (options_.normals == NormalsFrom::neighbours)
      refine();
    finish();
    return std::move(result_);
  }

private:
  template <class Work>
  void for_rows(const Work &work) {
    for (std::uint32_t first = 0; first < sensor_.resolution.y; first += rows_between_progress) {
      const std::uint32_t end = std::min(first + rows_between_progress, sensor_.resolution.y);
      tbb::parallel_for(first, end, work);
      if (progress_) // the passes that follow are not known before; each is taken for half of what is left
        progress_(1.0 -
                  std::exp2(-static_cast<double>(result_.passes)) * (1.0 - 0.5 * end / sensor_.resolution.y));
    }
    ++result_.passes;
  }
  std::size_t pixel(std::uint32_t row, std::uint32_t column) const {
    return std::size_t{row} * sensor_.resolution.x + column;
  }
  PixelStatus status(std::size_t pixel) const { return static_cast<PixelStatus>(result_.status[pixel]); }
  void set(std::size_t pixel, const FoundRange &found) {
    result_.status[pixel] = static_cast<std::uint32_t>(found.status);
    result_.range_m[pixel] = found.status == PixelStatus::corrected ? found.range_m : not_a_number;
  }
  PointOnRay point(std::size_t pixel) const {
    return {result_.ray[pixel], result_.range_m[pixel], result_.normal[pixel]};
  }
  RangeImage ranges() const {
    return {sensor_.resolution, result_.ray, result_.range_m, result_.normal, per_normal_m_, result_.noise_m};
  }

  void find_rays();
  void first_pass();
  FoundRange first_range(std::size_t pixel, double &offset_m) const;
  void find_sensitivity();
  void fit();
  void refine();
  double excess_rad(std::uint32_t row, std::uint32_t column, const SurfaceFit &fit) const;
  bool is_settled(std::size_t pixel) const;
  double refine_pixel(std::uint32_t row, std::uint32_t column);
  void finish();
  void finish_pixel(std::size_t pixel);
  void mark_edges();
  void mark_chance();

  const Sensor &sensor_;
  Lens lens_;
  RangeSearch search_;
  const MeasuredImage &image_;
  const CorrectionOptions &options_;
  const std::function<void(double)> &progress_;
  std::vector<glm::dvec2> area_points_;
  std::vector<SurfaceFit> fits_;
  std::vector<glm::dvec3> per_normal_m_;
  std::vector<double> moved_m_; // by the last pass
  CorrectedImage result_;
};

void Correction::find_rays() {
  const std::size_t pixels = pixels_of(sensor_);
  result_.range_m.assign(pixels, not_a_number);
  result_.correction_m = result_.normal_error_m = result_.range_m;
  result_.ray.assign(pixels, glm::dvec3(0.0));
  result_.status.assign(pixels, static_cast<std::uint32_t>(PixelStatus::not_measured));
  tbb::parallel_for(0u, sensor_.resolution.y, [&](std::uint32_t row) {
    for (std::uint32_t column = 0; column < sensor_.resolution.x; ++column) {
      const auto ray = lens_.ray(lens_.on_chip_m({column + 0.5, row + 0.5}));
      result_.ray[pixel(row, column)] = ray.value_or(glm::dvec3(0.0));
    }
  });
  result_.normal = result_.ray;
  for (glm::dvec3 &normal : result_.normal)
    normal = -normal;
}

// `offset_m`: of the measured distance and the range of the pixel before, about the same for this one.
FoundRange Correction::first_range(std::size_t pixel, double &offset_m) const {
  const double phase_rad = image_.phase_rad[pixel], ambiguity_m = search_.ambiguity_m();
  const double measured_m = ambiguity_m * phase_rad / (2.0 * std::numbers::pi);
  const bool guessed = !image_.guess_m.empty() && std::isfinite(image_.guess_m[pixel]);
  const double least_m = guessed ? image_.guess_m[pixel] - 0.5 * ambiguity_m : options_.least_range_m;
  const auto folded = [&](double range_m) {
    return range_m - ambiguity_m * std::floor((range_m - least_m) / ambiguity_m);
  };
  const FoundRange found = search_.within(
      {result_.ray[pixel], folded(measured_m - offset_m), result_.normal[pixel]}, phase_rad, least_m);
  if (found.status == PixelStatus::corrected)
    offset_m = std::remainder(measured_m - found.range_m, ambiguity_m);
  return found;
}

void Correction::first_pass() {
  for_rows([&](std::uint32_t row) {
    double offset_m = 0.0;
    for (std::uint32_t column = 0; column < sensor_.resolution.x; ++column) {
      const std::size_t at = pixel(row, column);
      if (std::isfinite(image_.phase_rad[at]) && result_.ray[at] != glm::dvec3(0.0))
        set(at, first_range(at, offset_m));
    }
  });
  result_.noise_m =
      std::fmax(noise_of(ranges()), image_.step_m > 0.0 ? image_.step_m / std::sqrt(12.0) : not_a_number);
  result_.fit_pixels =
      options_.fit_pixels > 0 ? options_.fit_pixels : fit_pixels_for(result_.noise_m, spacing_of(ranges()));
}

void Correction::find_sensitivity() {
  if (options_.backscatter != Backscatter::lambert || result_.passes > last_pass_of_sensitivity)
    return;
  per_normal_m_.assign(pixels_of(sensor_), glm::dvec3(0.0));
  tbb::parallel_for(std::size_t{0}, per_normal_m_.size(), [&](std::size_t at) {
    if (std::isfinite(result_.range_m[at]))
      per_normal_m_[at] = search_.range_per_normal_m(point(at));
  });
}

// A normal stays as uncertain as it was at first: where no plane fits, a pixel's range and its normal settle
// on one that does, by and by, as each follows from the other.
void Correction::fit() {
  find_sensitivity();
  RangeImage image = ranges();
  image.normals_guessed = fits_.empty();
  std::vector<SurfaceFit> fits = fit_surfaces(image, result_.fit_pixels);
  for (std::size_t at = 0; at < fits_.size(); ++at) {
    fits[at].uncertainty_rad = std::max(fits[at].uncertainty_rad, fits_[at].uncertainty_rad);
    fits[at].one_sided = fits[at].one_sided || fits_[at].one_sided;
  }
  fits_ = std::move(fits);
}

void Correction::refine() {
  std::vector<double> most_moved_m(sensor_.resolution.y);
  moved_m_.assign(result_.range_m.size(), 0.0);
  do {
    fit();
    for_rows([&](std::uint32_t row) {
      most_moved_m[row] = 0.0;
      for (std::uint32_t column = 0; column < sensor_.resolution.x; ++column)
        most_moved_m[row] = std::max(most_moved_m[row], refine_pixel(row, column));
    });
    result_.last_change_m = std::ranges::max(most_moved_m);
  } while (result_.last_change_m > std::max(settled_m, settled_noises * result_.noise_m) &&
           result_.passes < most_passes);
}

// By how much the phase of the pixel's mean exceeds that of its centre, on a surface that bends. 0 where it
// ends within the pixel.
double Correction::excess_rad(std::uint32_t row, std::uint32_t column, const SurfaceFit &fit) const {
  const PointOnRay at = point(pixel(row, column));
  const double height_m = at.range_m * glm::dot(at.normal, at.ray);
  std::array<PointOnRay, 4> around;
  for (std::size_t i = 0; i < area_points_.size(); ++i) {
    const glm::dvec2 &off = area_points_[i];
    const auto ray = lens_.ray(lens_.on_chip_m(glm::dvec2(column, row) + 0.5 + off));
    const double cosine = ray ? glm::dot(at.normal, *ray) : 0.0;
    if (!(cosine < 0.0))
      return 0.0;
    const double bent_m = 0.5 * glm::dot(off * off, fit.bend_m);
    around[i] = {*ray, height_m / cosine + bent_m,
                 glm::normalize(at.normal + off.x * fit.turn_columns + off.y * fit.turn_rows)};
  }
  return search_.phase_excess_rad(at, around);
}

// Whether another normal moves the range of a pixel without an area by less than is worth a search.
bool Correction::is_settled(std::size_t at) const {
  constexpr double least_move_m = 1e-10;
  return area_points_.empty() && !per_normal_m_.empty() &&
         std::abs(glm::dot(per_normal_m_[at], fits_[at].normal - result_.normal[at])) < least_move_m;
}

// Returns how far the range moved, where the pixel is sure.
double Correction::refine_pixel(std::uint32_t row, std::uint32_t column) {
  const std::size_t at = pixel(row, column);
  if (!std::isfinite(result_.range_m[at]))
    return 0.0;
  const SurfaceFit &fit = fits_[at];
  moved_m_[at] = 0.0;
  if (is_settled(at))
    return 0.0;
  result_.normal[at] = fit.normal;
  const double before_m = result_.range_m[at];
  double phase_rad = image_.phase_rad[at];
  if (!area_points_.empty())
    phase_rad -= excess_rad(row, column, fit);
  const FoundRange found = search_.nearest(point(at), phase_rad);
  if (found.status == PixelStatus::no_light && fit.uncertainty_rad > 0.05) { // an unlikely normal
    result_.normal[at] = -result_.ray[at];
    fits_[at].uncertainty_rad = 1.0;
    return 0.0;
  }
  set(at, found);
  moved_m_[at] = std::abs(found.range_m - before_m);
  return found.status == PixelStatus::corrected && fit.uncertainty_rad < 1e-2 ? moved_m_[at] : 0.0;
}

void Correction::finish_pixel(std::size_t at) {
  if (status(at) != PixelStatus::corrected)
    return;
  const double ambiguity_m = search_.ambiguity_m();
  const double measured_m = ambiguity_m * image_.phase_rad[at] / (2.0 * std::numbers::pi);
  result_.correction_m[at] = std::remainder(measured_m - result_.range_m[at], ambiguity_m);
  if (fits_.empty())
    return;
  const double by_normal_m =
      per_normal_m_.empty() ? 0.0 : glm::length(per_normal_m_[at]) * fits_[at].uncertainty_rad;
  result_.normal_error_m[at] =
      std::max({by_normal_m, area_points_.empty() ? 0.0 : fits_[at].off_m, moved_m_[at]});
}

void Correction::mark_edges() {
  std::vector<double> errors_m;
  for (std::size_t at = 0; at < fits_.size(); ++at)
    if (!fits_[at].one_sided && std::isfinite(result_.normal_error_m[at]))
      errors_m.push_back(result_.normal_error_m[at]);
  result_.edge_limit_m = least_edge_limit_m;
  if (!errors_m.empty()) {
    const auto middle = errors_m.begin() + static_cast<std::ptrdiff_t>(errors_m.size() / 2);
    std::nth_element(errors_m.begin(), middle, errors_m.end());
    result_.edge_limit_m = std::fmax(least_edge_limit_m, edge_errors * *middle);
  }
  for (std::size_t at = 0; at < fits_.size(); ++at)
    if (status(at) == PixelStatus::corrected &&
        (fits_[at].one_sided || fits_[at].uncertainty_rad > edge_rad ||
         !(result_.normal_error_m[at] <= result_.edge_limit_m)))
      result_.status[at] = static_cast<std::uint32_t>(PixelStatus::edge);
}

void Correction::mark_chance() {
  const std::vector<std::uint32_t> marked = result_.status;
  const glm::ivec2 resolution(sensor_.resolution);
  const auto is_interior = [&](int row, int column) {
    return row >= 0 && row < resolution.y && column >= 0 && column < resolution.x &&
           marked[pixel(static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column))] ==
               static_cast<std::uint32_t>(PixelStatus::corrected);
  };
  tbb::parallel_for(0, resolution.y, [&](int row) {
    for (int column = 0; column < resolution.x; ++column) {
      int neighbours = -1; // itself
      for (int down = -1; down <= 1; ++down)
        for (int across = -1; across <= 1; ++across)
          neighbours += is_interior(row + down, column + across) ? 1 : 0;
      if (is_interior(row, column) && neighbours < least_neighbours)
        result_.status[pixel(static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column))] =
            static_cast<std::uint32_t>(PixelStatus::edge);
    }
  });
}

void Correction::finish() {
  tbb::parallel_for(std::size_t{0}, result_.range_m.size(), [&](std::size_t at) { finish_pixel(at); });
  if (!fits_.empty()) {
    mark_edges();
    mark_chance();
  }
  for (const std::uint32_t status : result_.status)
    ++result_.counts[status];
}

} // namespace

CorrectedImage correct(const Sensor &sensor, const std::vector<Illuminator> &illuminators,
                       const MeasuredImage &image, const CorrectionOptions &options,
                       const std::function<void(double)> &progress) {
  return Correction(sensor, illuminators, image, options, progress).run();
}

double distance_of_phase_m(double phase_rad, double modulation_hz) {
  return speed_of_light_m_s * phase_rad / (4.0 * std::numbers::pi * modulation_hz);
}

double phase_of_distance_rad(double distance_m, double modulation_hz) {
  return 4.0 * std::numbers::pi * modulation_hz * distance_m / speed_of_light_m_s;
}

} // namespace pmdsim
