#include "engine/reference/bounce/indirect_return.h"

#include <algorithm>
#include <cmath>

namespace pmdsim::reference {

namespace {

constexpr std::size_t most_paths_kept = 4096;

std::vector<ReturnSum> empty_sums(const Sensor &sensor) {
  std::vector<ReturnSum> sums;
  sums.reserve(sensor.modulation_hz.size());
  for (const double modulation_hz : sensor.modulation_hz)
    sums.emplace_back(sensor, modulation_hz);
  return sums;
}

void move_to(std::vector<ReturnSum> &sums, std::vector<LightPath> &paths) {
  for (ReturnSum &sum : sums)
    sum.add(paths);
  paths.clear();
}

std::vector<ReturnSum> traced(const Sensor &sensor, const PathTracer &tracer,
                              const std::vector<std::optional<SurfacePoint>> &seen, PathNumbers numbers,
                              std::uint32_t paths) {
  std::vector<ReturnSum> sums = empty_sums(sensor);
  std::vector<LightPath> found;
  for (std::uint32_t path = 0; path < paths; ++path) {
    numbers.begin_path();
    const auto sample = static_cast<std::size_t>(numbers.next() * static_cast<double>(seen.size()));
    if (seen[sample])
      tracer.trace(*seen[sample], numbers, found);
    if (found.size() >= most_paths_kept)
      move_to(sums, found);
  }
  move_to(sums, found);
  return sums;
}

// The mean of replicates, and the variance of that mean.
IndirectReturn mean_of(const std::vector<MeanReturn> &replicates) {
  const auto count = static_cast<double>(replicates.size());
  IndirectReturn result{{0.0, std::vector<double>(replicates.front().taps.size()), 0.0}};
  for (const MeanReturn &replicate : replicates) {
    result.mean.z += replicate.z / count;
    result.mean.weight += replicate.weight / count;
    result.mean.mean_radiance += replicate.mean_radiance / count;
    for (std::size_t k = 0; k < replicate.taps.size(); ++k)
      result.mean.taps[k] += replicate.taps[k] / count;
  }
  for (const MeanReturn &replicate : replicates) {
    const std::complex<double> off = replicate.z - result.mean.z;
    const double share = 1.0 / (count * (count - 1.0));
    result.real_variance += share * off.real() * off.real();
    result.imaginary_variance += share * off.imag() * off.imag();
    result.covariance += share * off.real() * off.imag();
  }
  return result;
}

} // namespace

double IndirectReturn::standard_error() const { return std::sqrt(real_variance + imaginary_variance); }

double IndirectReturn::standard_error_across(const std::complex<double> &z) const {
  const std::complex<double> along = z / std::abs(z);
  const double variance = along.imag() * along.imag() * real_variance +
                          along.real() * along.real() * imaginary_variance -
                          2.0 * along.real() * along.imag() * covariance;
  return std::sqrt(std::max(variance, 0.0));
}

std::vector<IndirectReturn> indirect_returns(const Sensor &sensor, const PathTracer &tracer,
                                             const std::vector<std::optional<SurfacePoint>> &seen,
                                             std::uint32_t pixel, std::uint32_t paths) {
  const std::uint32_t of_replicate = paths / replicate_count + (paths % replicate_count > 0 ? 1 : 0);
  std::vector<std::vector<MeanReturn>> replicates(sensor.modulation_hz.size());
  for (std::uint32_t replicate = 0; replicate < replicate_count; ++replicate) {
    const PathNumbers numbers(std::uint64_t{pixel} * replicate_count + replicate + 1);
    const auto sums = traced(sensor, tracer, seen, numbers, of_replicate);
    for (std::size_t i = 0; i < sums.size(); ++i)
      replicates[i].push_back(sums[i].mean(of_replicate));
  }
  std::vector<IndirectReturn> returns;
  returns.reserve(replicates.size());
  for (const std::vector<MeanReturn> &of_frequency : replicates)
    returns.push_back(mean_of(of_frequency));
  return returns;
}

} // namespace pmdsim::reference
